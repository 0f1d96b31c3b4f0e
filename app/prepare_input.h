// A picture as the stages of `prepare` take it. In: a file. Out: linear light that is not cut off anywhere,
// and what is to be done with it in the end.
#pragma once

#include <filesystem>
#include <string>

#include "core/image.h"
#include "core/progress.h"
#include "prepare/fill.h"
#include "source/source.h"

namespace astrosplat {

struct PrepareInput {
    Image image;  // RGBA, premultiplied; FITS: 0 at its black, 1 at its white point, beyond them as measured
    PixelMask empty;          // pixels without a value: filled in `image`, their alpha is 0
    double saturation = 0.0;  // linear light from which a channel tells nothing more; infinite where unknown
    TextureSettings::Stretch stretch = TextureSettings::Stretch::linear;  // still to come
    std::string credit;
};

/// Throws InputError, Cancelled.
PrepareInput read_prepare_input(const std::filesystem::path& file, const TextureSettings& settings,
                                const Progress& progress);

/// The stretch that was still to come, as the texture of a scene would have had it: the result is linear
/// light.
void apply_stretch(Image& image, TextureSettings::Stretch stretch, double softening);

}  // namespace astrosplat
