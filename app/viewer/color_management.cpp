#include "viewer/color_management.h"

#include <utility>

namespace astrosplat {

void ColorManagement::update(const OcioParams& params, bool seen) {
    const std::filesystem::path file = config_file(params);
    if (!params.wanted() && (!seen || file.empty())) {
        asked_.reset();
        transform_.reset();
        status_.reset();
        return;
    }
    const Asked now{params, file, stamp_of(file)};
    if (asked_ == now) return;
    asked_ = now;
    read(now);
}

void ColorManagement::read(const Asked& now) {
    ColorStatus status;
    transform_.reset();
    try {
        if (!now.file.empty()) status.config = read_color_config(now.file);
        if (now.params.wanted()) transform_ = display_transform(now.params);
    } catch (const InputError& error) {
        status.error = error.what();
    }
    if (transform_) {
        status.display = transform_->display();
        status.view = transform_->view();
        status.space = transform_->space();
    }
    status_ = std::move(status);
}

}  // namespace astrosplat
