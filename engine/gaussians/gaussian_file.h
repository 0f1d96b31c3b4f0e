// Gaussians into files that other programs read: the PLY of 3D Gaussian Splatting, binary glTF with
// KHR_gaussian_splatting, USD and SPZ. Atomic, and the same bytes for any thread count. Credit and origin
// stand in PLY's comments, as glTF's asset.copyright and asset.extras.origin, and in USD's customLayerData.
#pragma once

#include "core/atomic_file.h"
#include "core/progress.h"
#include "gaussians/gaussians.h"

namespace astrosplat {

/// Binary little endian: x y z, normals of 0, f_dc_0..2 = (colour - 1/2) sqrt(4 pi), f_rest_* where there are
/// harmonics beyond degree 0 (all of red, of green, of blue), logit of alpha, natural logarithms of the
/// scale, and rotation as w x y z. Its readers blend the colours as they are, so these are encoded for a
/// display. Throws OutputError, Cancelled.
void write_gaussian_ply(const WriteTarget& target, const Gaussians& gaussians, const Progress& progress = {});

/// `encoded`: colours were encoded for a display (srgb_rec709_display); else they are linear light
/// (lin_rec709_display). COLOR_0, for programs that draw points, is linear either way. Throws InputError for
/// more Gaussians than 4 GiB hold, the most of this format, OutputError, Cancelled.
void write_gaussian_glb(const WriteTarget& target, const Gaussians& gaussians, bool encoded,
                        const Progress& progress = {});

/// USD as text (.usda): one ParticleField3DGaussianSplat of OpenUSD's UsdVol (26.03) with positions,
/// orientations (w first), scales (standard deviations), opacities and harmonics, those of each together and
/// in the order of their degrees; y up. Shortest numbers that read back to the same floats. Throws
/// OutputError, Cancelled.
void write_gaussian_usda(const WriteTarget& target, const Gaussians& gaussians,
                         const Progress& progress = {});

/// SPZ of version 4: positions of 24 bits, scales of 1/16 in their logarithm, quaternions of 10 bits a
/// number, colours and alphas of 8, harmonics of 5 and 4. Y and z change signs, so that it lies as the PLY
/// does. Encoded for a display; no credit. Throws InputError (memory), OutputError, Cancelled.
void write_gaussian_spz(const WriteTarget& target, const Gaussians& gaussians, const Progress& progress = {});

}  // namespace astrosplat
