// Results of registration as the placement of a reference over a frame.
#include "viewer/reference_picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

namespace astrosplat {
namespace {

/// Three blobs that make no symmetric figure, on a picture of this size.
Image blobs(std::int64_t width, std::int64_t height) {
    Image image = make_image(width, height, 4, 1.0f);
    const double h = static_cast<double>(height);
    for (std::int64_t y = 0; y < height; ++y)
        for (std::int64_t x = 0; x < width; ++x) {
            double light = 0.0;
            for (const glm::dvec3& blob : {glm::dvec3(0.5, 0.5, 0.12), {0.8, 0.4, 0.06}, {0.4, 0.8, 0.08}}) {
                const double r =
                    glm::distance(glm::dvec2(double(x), double(y)) / h, glm::dvec2(blob)) / blob.z;
                light += 0.6 * std::exp(-r * r);
            }
            for (int c = 0; c < 3; ++c) image.at(x, y)[c] = static_cast<float>(light * (1.0 - 0.2 * c));
        }
    return image;
}

/// A view that shows the picture where `placed` puts it.
Image view_of(const Image& picture, const ReferenceParams& placed, const FrameOnScreen& frame, int width,
              int height) {
    const PicturePlace place = place_of(placed, double(picture.width) / double(picture.height), frame);
    Image view = make_image(width, height, 4, 0.0f);
    for (std::int64_t y = 0; y < height; ++y)
        for (std::int64_t x = 0; x < width; ++x) {
            const glm::dvec2 from = glm::dvec2(double(x) + 0.5, double(y) + 0.5) - place.corner;
            const double u = glm::dot(from, place.right) / glm::dot(place.right, place.right);
            const double v = glm::dot(from, place.down) / glm::dot(place.down, place.down);
            if (u < 0.0 || v < 0.0 || u >= 1.0 || v >= 1.0) continue;
            const auto px = static_cast<std::int64_t>(u * double(picture.width));
            const auto py = static_cast<std::int64_t>(v * double(picture.height));
            std::copy_n(picture.at(px, py), 4, view.at(x, y));
        }
    return view;
}

TEST(ReferenceAlignment, FindsThePlacementThatMadeTheView) {
    AlignmentRequest request;
    request.picture = blobs(300, 200);
    request.frame = {{210.0, 140.0}, 240.0};  // the view is a part of it
    for (const bool mirrored : {false, true}) {
        ReferenceParams placed;
        placed.file = "blobs.png";
        placed.mirrored = mirrored;
        request.reference = placed;
        placed.position = {0.1, -0.05};
        placed.scale = 0.8;
        placed.rotate = 25.0;
        request.view = view_of(request.picture, placed, request.frame, 400, 260);
        const AlignmentFound found = align_reference(request);
        ASSERT_TRUE(found.reference);
        EXPECT_EQ(found.reference->file, "blobs.png");
        EXPECT_EQ(found.reference->mirrored, mirrored);
        EXPECT_NEAR(found.reference->position.x, 0.1, 1.0 / 240.0);
        EXPECT_NEAR(found.reference->position.y, -0.05, 1.0 / 240.0);
        EXPECT_NEAR(found.reference->scale, 0.8, 0.004);
        EXPECT_NEAR(found.reference->rotate, 25.0, 0.3);
    }
}

TEST(ReferenceAlignment, AnEmptyViewHasNone) {
    AlignmentRequest request;
    request.picture = blobs(300, 200);
    request.frame = {{200.0, 120.0}, 240.0};
    request.view = make_image(400, 240, 4, 0.0f);
    EXPECT_FALSE(align_reference(request).reference);
}

}  // namespace
}  // namespace astrosplat
