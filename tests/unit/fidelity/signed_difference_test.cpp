// Colours of a signed difference.
#include "fidelity/display.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/vec4.hpp>

#include "core/color.h"

namespace astrosplat {
namespace {

/// One pixel of linear light whose displayed value is `displayed`.
Image pixel(float displayed) {
    const float linear = static_cast<float>(real::srgb_to_linear(displayed));
    return make_image(1, 1, 3, linear);
}

glm::vec4 shown(float a, float b) {
    const Image image = signed_difference(pixel(a), pixel(b));
    const float* p = image.at(0, 0);
    return {p[0], p[1], p[2], p[3]};
}

TEST(SignedDifference, IsOrangeWhereBrighterAndBlueWhereDarker) {
    const glm::vec4 none = shown(0.5f, 0.5f), more = shown(0.6f, 0.5f), less = shown(0.5f, 0.6f);
    EXPECT_LT(std::max({none.x, none.y, none.z}), 0.1f);
    EXPECT_NEAR(more.x, 1.0f, 1e-3f);
    EXPECT_LT(more.z, 0.2f);
    EXPECT_NEAR(less.z, 1.0f, 1e-3f);
    EXPECT_LT(less.x, 0.3f);
    EXPECT_EQ(none.w, 1.0f);
}

TEST(SignedDifference, GrowsEvenlyUpToFullColour) {
    const glm::vec4 none = shown(0.3f, 0.3f), half = shown(0.35f, 0.3f), full = shown(0.4f, 0.3f);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(half[k], 0.5f * (none[k] + full[k]), 1e-3f);
    EXPECT_EQ(shown(1.0f, 0.0f), shown(0.7f, 0.2f));
}

}  // namespace
}  // namespace astrosplat
