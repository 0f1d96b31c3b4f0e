#include "source/prepared_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/text.h"
#include "image/blur.h"
#include "prepare/cut.h"
#include "prepare/fill.h"
#include "prepare/lupton.h"
#include "prepare/star_removal.h"
#include "source/prepare_input.h"
#include "source/texture.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

// The stages, on a picture that may have been halved, as often as its masks are then.
class Preparation {
  public:
    Preparation(PrepareInput input, const TextureSettings& settings, const Progress& progress)
        : input_(std::move(input)), settings_(settings), params_(settings.prepare), progress_(progress) {}

    void halve_to(std::int64_t most_px) {
        full_ = {input_.image.width, input_.image.height, 4, {}};
        while (most_px > 0 && std::max(input_.image.width, input_.image.height) > most_px) {
            input_.image = halved(input_.image);
            ++halvings_;
        }
        if (halvings_ > 0) input_.empty = empty_pixels(input_.image);
    }

    PreparedPicture run() {
        PreparedPicture result;
        if (!params_.fill.empty())
            fill(input_.image, bright_pixels(mask("fill", params_.fill)), FillKind::texture, progress_);
        if (params_.stars == PrepareParams::Stars::remove) take_stars_away(result);
        if (params_.background != PrepareParams::Background::keep) {
            result.sky = fit_sky(input_.image, static_cast<int>(params_.background) - 1);
            subtract_sky(input_.image, *result.sky);
        }
        if (params_.lupton)
            apply_lupton(input_.image, {params_.q, params_.lupton_stretch});
        else
            apply_stretch(input_.image, input_.stretch, settings_.softening);
        cut();
        result.image = std::move(input_.image);
        result.credit = std::move(input_.credit);
        return result;
    }

  private:
    static PixelMask empty_pixels(const Image& image) {
        PixelMask empty = make_mask(image.width, image.height);
        for (std::size_t i = 0; i < empty.pixels.size(); ++i)
            empty.pixels[i] = !(image.pixels[4 * i + 3] > 0.5f);
        return empty;
    }

    Image mask(const char* key, const fs::path& file) const {
        Image picture = read_mask_like(full_, std::string("prepare.") + key, file);
        for (int i = 0; i < halvings_; ++i) picture = halved(picture);
        return picture;
    }

    void take_stars_away(PreparedPicture& result) {
        claim_memory(star_removal_bytes(input_.image), "star removal");
        StarRemoval removal = remove_stars(
            input_.image, {params_.threshold, params_.saturation.value_or(input_.saturation)}, progress_);
        input_.image = std::move(removal.starless);
        result.stars = std::move(removal.stars);
    }

    void cut() {
        Image& image = input_.image;
        if (params_.ellipse) {
            const glm::dvec4 e = *params_.ellipse / std::exp2(halvings_);
            cut_ellipse(image, {{e.x, e.y}, {e.z, e.w}, -params_.turn, params_.feather});
        }
        if (!params_.mask.empty()) cut_with_mask(image, mask("mask", params_.mask));
        if (params_.alpha) alpha_from_luminance(image, params_.alpha->x, params_.alpha->y);
        for (std::size_t i = 0; i < input_.empty.pixels.size(); ++i)
            if (input_.empty.pixels[i]) std::fill_n(image.pixels.data() + 4 * i, 4, 0.0f);
    }

    PrepareInput input_;
    const TextureSettings& settings_;
    const PrepareParams& params_;
    const Progress& progress_;
    Image full_;  // of the size of the masks; without pixels
    int halvings_ = 0;
};

}  // namespace

PreparedPicture prepare_picture(const std::vector<fs::path>& files, const TextureSettings& settings,
                                const Progress& progress, std::int64_t most_px) {
    PrepareInput input = files.size() == 1
                             ? read_prepare_input(files[0], settings, progress)
                             : read_three_filters({files[0], files[1], files[2]}, settings, progress);
    if (!settings.prepare.align.empty()) align_to(settings.prepare.align, settings, input, progress);
    Preparation preparation(std::move(input), settings, progress);
    preparation.halve_to(most_px);
    return preparation.run();
}

PreparedPicture make_prepared(const std::vector<fs::path>& files, const TextureSettings& settings,
                              const Progress& progress) {
    return prepare_picture(files, settings, progress);
}

Image without_plain_alpha(Image image) {
    const std::int64_t pixels = image.width * image.height;
    for (std::int64_t i = 0; i < pixels; ++i)
        if (image.pixels[4 * i + 3] != 1.0f) return image;
    Image colors = make_image(image.width, image.height, 3);
    for (std::int64_t i = 0; i < pixels; ++i)
        std::copy_n(image.pixels.data() + 4 * i, 3, colors.pixels.data() + 3 * i);
    return colors;
}

Image read_mask_like(const Image& like, const std::string& option, const fs::path& file) {
    Image mask = load_raw_image(file);
    if (mask.width != like.width || mask.height != like.height)
        bad_input(option, file.string(), fmt::format("{}x{} px like the picture", like.width, like.height),
                  fmt::format("{}x{} px", mask.width, mask.height));
    return mask;
}

PixelMask bright_pixels(const Image& mask) {
    PixelMask bright = make_mask(mask.width, mask.height);
    for (std::size_t i = 0; i < bright.pixels.size(); ++i) bright.pixels[i] = mask.pixels[3 * i] > 0.0f;
    return bright;
}

}  // namespace astrosplat
