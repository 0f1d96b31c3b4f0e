// A picture as the stages of its preparation take it. In: a file. Out: linear light that is not cut off
// anywhere, and what is to be done with it in the end.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>

#include "core/image.h"
#include "core/progress.h"
#include "prepare/fill.h"
#include "prepare/sky_grid.h"
#include "source/source.h"

namespace astrosplat {

struct PrepareInput {
    Image image;  // RGBA, premultiplied; FITS: 0 at its black, 1 at its white point, beyond them as measured
    PixelMask empty;          // pixels without a value: filled in `image`, their alpha is 0
    double saturation = 0.0;  // linear light from which a channel tells nothing more; infinite where unknown
    TextureSettings::Stretch stretch = TextureSettings::Stretch::linear;  // still to come
    std::string credit;
    std::optional<TanGrid> grid;  // how the sky lies on it, where that is known
    std::string name;             // of its file
};

/// Throws InputError, Cancelled.
PrepareInput read_prepare_input(const std::filesystem::path& file, const TextureSettings& settings,
                                const Progress& progress);

/// Three filters as red, green and blue. Where the sky is known on all of them (FITS) and their grids differ,
/// green and blue are sampled on red's; else they must have one size. Throws InputError, Cancelled.
PrepareInput read_three_filters(const std::array<std::filesystem::path, 3>& files,
                                const TextureSettings& settings, const Progress& progress);

/// Puts a picture on the grid that the FITS picture `reference` has on the sky, with its size. Throws
/// InputError where the sky is not known on both, Cancelled.
void align_to(const std::filesystem::path& reference, const TextureSettings& settings, PrepareInput& input,
              const Progress& progress);

/// The stretch that was still to come, as the texture of a scene would have had it: the result is linear
/// light.
void apply_stretch(Image& image, TextureSettings::Stretch stretch, double softening);

}  // namespace astrosplat
