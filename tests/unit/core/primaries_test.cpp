// Matrices between primaries against published ones and what must hold for any.
#include "core/color.h"

#include <gtest/gtest.h>

#include <glm/vec3.hpp>

namespace astrosplat {
namespace {

TEST(Primaries, Rec709ToAcescgIsThePublishedMatrix) {
    // As in the ACES configs of OpenColorIO (Bradford), by rows.
    const double published[3][3] = {
        {0.613097, 0.339523, 0.047379}, {0.070194, 0.916354, 0.013452}, {0.020616, 0.109570, 0.869815}};
    const glm::dmat3 matrix = primaries_matrix(rec709_chromaticities, acescg_chromaticities);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            EXPECT_NEAR(matrix[column][row], published[row][column], 1e-6) << row << " " << column;
}

TEST(Primaries, WhiteStaysWhiteAndTheWayBackIsTheInverse) {
    const glm::dmat3 there = primaries_matrix(rec709_chromaticities, acescg_chromaticities),
                     back = primaries_matrix(acescg_chromaticities, rec709_chromaticities);
    const glm::dvec3 white = there * glm::dvec3(1.0);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(white[c], 1.0, 1e-12);
        for (int r = 0; r < 3; ++r) EXPECT_NEAR((back * there)[c][r], c == r ? 1.0 : 0.0, 1e-12);
    }
}

}  // namespace
}  // namespace astrosplat
