// A picture made ready for a scene: put on another's grid, its holes filled, without its stars and its sky,
// cut out. In: files and what is asked for. Out: linear light that is not cut off anywhere, and what was
// taken away.
#pragma once

#include "core/image.h"
#include "core/progress.h"
#include "prepare/stages.h"
#include "prepare/star_fit.h"
#include "source/source.h"

namespace astrosplat {

struct PreparedPicture {
    Image image;                     // RGBA, premultiplied; alpha is 1 everywhere where nothing is missing
    std::vector<PictureStar> stars;  // taken away, the brightest first
    std::optional<SkySurface> sky;   // taken off
    std::string credit;
};

/// One picture, or three for red, green and blue, through the stages of settings.prepare in their order. A
/// picture whose longer side exceeds `most_px` is halved first until it does not, for a quick look; 0: never.
/// Other files of the settings must have the picture's size. Throws InputError, Cancelled.
PreparedPicture prepare_picture(const std::vector<fs::path>& files, const TextureSettings& settings,
                                const Progress& progress = {}, std::int64_t most_px = 0);

/// The source of load_texture()'s prepared pictures: prepare_picture(), or a store of its earlier results.
/// Without stars and sky.
using PictureMaker = std::function<PreparedPicture(
    const std::vector<fs::path>& files, const TextureSettings& settings, const Progress& progress)>;

PreparedPicture make_prepared(const std::vector<fs::path>& files, const TextureSettings& settings,
                              const Progress& progress);

/// Without the alpha where that is 1 everywhere: then a scene takes it from the brightness.
Image without_plain_alpha(Image image);

/// A picture of the size of another. Throws InputError, which names `option`.
Image read_mask_like(const Image& like, const std::string& option, const fs::path& file);

/// The pixels that are brighter than black.
PixelMask bright_pixels(const Image& mask);

}  // namespace astrosplat
