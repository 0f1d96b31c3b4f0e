// Shared by the tests of Gaussians' files: reading bytes, messages, and the comparison with what was made.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "core/color.h"
#include "splat_files/splat_file.h"
#include "support/capture.h"
#include "unit/splat_files/file_support.h"

namespace astrosplat::test {

class GaussianFiles : public SplatFileTest {
  protected:
    SplatSet read(const std::string& bytes, const char* name = "a.ply") {
        return read_splats(write(name, bytes));
    }
    std::string error(const std::string& bytes, const char* name = "a.ply") {
        return error_of(write(name, bytes), [](const auto& file) { read_splats(file); });
    }
    std::string error_glb(const std::string& bytes) { return error(bytes, "a.glb"); }
    std::string error_usda(const std::string& bytes) { return error(bytes, "a.usda"); }
};

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

inline void expect_near(const SplatSet& set, const std::vector<Trained>& all, int degree) {
    ASSERT_EQ(set.size(), std::int64_t(all.size()));
    EXPECT_NO_THROW(check_consistent(set));
    ASSERT_EQ(set.harmonics.empty(), degree == 0);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Trained& g = all[i];
        EXPECT_EQ(set.id[i], i);
        EXPECT_NEAR(set.alpha[i], g.opacity, 1e-6);
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(set.position[i][k], g.position[k], 1e-6);
            EXPECT_NEAR(set.scale[i][k] / g.scale[k], 1.0, 1e-6);
            const double color = std::max(0.0, 0.5 + 0.28209479177387814 * g.harmonics[0][k]);
            EXPECT_NEAR(set.color[i][k], real::srgb_to_linear(color), 1e-5);
            for (std::size_t j = 0; j < 16 && degree > 0; ++j)
                EXPECT_NEAR(set.harmonics[i].c[j][k], g.harmonics[j][k], 1e-6) << j;
        }
        EXPECT_NEAR(std::fabs(glm::dot(glm::dvec4(set.rotation[i]), g.rotation)), 1.0, 1e-6);
    }
}

}  // namespace astrosplat::test
