#include "fidelity/front.h"

#include <cassert>

#include "fidelity/display.h"
#include "fidelity/likeness.h"

namespace astrosplat {

FrontFidelity front_fidelity(const Image& rendered, const Image& reference, double border) {
    assert(rendered.width == reference.width && rendered.height == reference.height);
    const auto margin = static_cast<std::int64_t>(border * static_cast<double>(rendered.width) + 0.5);
    const Image ours = inner_colors(rendered, margin), theirs = inner_colors(reference, margin);
    FrontFidelity result;
    result.width_px = rendered.width;
    result.height_px = rendered.height;
    result.psnr_db = psnr_db(ours, theirs);
    result.ssim = ssim(ours, theirs);
    result.flux = flux_ratios(ours, theirs);
    result.ciede2000 = color_differences(ours, theirs);
    result.power = power_by_scale(ours, theirs);
    return result;
}

// The cropped pictures, and the five channels of ssim with two copies on their way through a blur.
std::int64_t front_fidelity_bytes(std::int64_t width_px, std::int64_t height_px) {
    constexpr std::int64_t floats_per_pixel = 2 * 3 + 3 * 5;
    return width_px * height_px * floats_per_pixel * static_cast<std::int64_t>(sizeof(float));
}

}  // namespace astrosplat
