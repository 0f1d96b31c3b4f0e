// A whole sky made of one picture of a part of it: cut-outs of the picture, turned and mirrored at random, on
// places all over the sphere. In: linear light. Out: six faces of a cube.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>

#include "core/image.h"
#include "core/progress.h"

namespace astrosplat {

struct SkyTiling {
    double height_deg = 10.0;  // that the picture's shorter side covers on the sky
    std::uint32_t seed = 1;
    std::int64_t face_px = 2048;  // a side
    bool operator==(const SkyTiling&) const = default;
};

/// RGB, in the order of cube_faces.h. An object of the picture (picture_objects.h) is in a cut-out whole or
/// not at all, so there are no cut ones and as many a square degree as in the picture; what is between them
/// goes over softly from one cut-out into the next. Neighbours show different parts of the
/// picture. The mean light of all directions is the picture's. The same bits with any number of threads.
/// Throws InputError for a picture of less than 32 px a side; Cancelled.
std::array<Image, 6> tiled_sky(const Image& picture, const SkyTiling& tiling, const Progress& progress = {});

/// The same of a picture's file, read as linear light.
std::array<Image, 6> tiled_sky_of(const std::filesystem::path& file, const SkyTiling& tiling,
                                  const Progress& progress = {});

/// tiled_sky_of, or what keeps its results (sets/sky_cache.h).
using SkyMaker =
    std::function<std::array<Image, 6>(const std::filesystem::path&, const SkyTiling&, const Progress&)>;

}  // namespace astrosplat
