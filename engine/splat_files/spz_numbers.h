// What reading and writing SPZ (Niantic) share. The numbers are those of its own library, nianticlabs/spz.
#pragma once

#include "core/standard.h"

namespace astrosplat::spz {

inline constexpr std::string_view magic = "NGSP";
inline constexpr std::size_t header_bytes = 32,
                             entry_bytes = 16;  // of version 4: its header, a stream's sizes
inline constexpr int streams = 6;               // positions, alphas, colours, scales, rotations, harmonics
inline constexpr double color_scale = 0.15;     // of coefficients of degree 0
inline constexpr double log_scale_steps = 16.0, log_scale_least = -10.0;
inline constexpr int quaternion_steps = 511;  // up to sqrt(1/2), besides the sign

/// Its axes lead right, up and back, PLY's right, down and front: y and z change signs, of a quaternion too,
/// and these of the harmonics beyond degree 0.
inline constexpr std::array<float, 15> harmonic_signs = {-1, -1, 1, -1, 1, 1, -1, 1, -1, 1, -1, -1, 1, -1, 1};

}  // namespace astrosplat::spz
