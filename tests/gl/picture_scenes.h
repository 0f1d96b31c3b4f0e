// Small sets of splats and cameras that preview and offline renderer both draw.
#pragma once

#include "camera/camera.h"
#include "gl/preview.h"

namespace astrosplat::test {

/// A flat cloud of `count` splats in [-1, 1] x [-0.2, 0.2] x [-1, 1], with every array a set can have;
/// places, colours and alpha are hashes of (seed, id).
std::shared_ptr<const SplatSet> cloud(std::int64_t count, std::uint32_t seed);

/// A layer of such a cloud with splats of this radius, drawn as `render` says.
PreviewLayer cloud_layer(std::int64_t count, std::uint32_t seed, float radius, const LayerRender& render);

/// Looking at the origin from (0.6, 1.4, 2.2).
Camera perspective_camera(int width, int height);
Camera orthographic_camera(int width, int height);

/// A sky of a few texels with mip levels, equirectangular or a cube, turned and brightened a little.
Environment small_sky(int faces);

/// The same layers through the offline renderer.
Image offline(const std::vector<PreviewLayer>& layers, const Camera& camera, const Environment* environment,
              int width, int height);

/// How alike two pictures are after the sRGB view, colours over black.
struct Likeness {
    double psnr_db = 0.0;
    double difference_999 = 0.0;  // 99.9th percentile of absolute differences of display values
    double brightness = 0.0;      // mean linear light of the first over that of the second
};
Likeness compare_shown(const Image& a, const Image& b);

}  // namespace astrosplat::test
