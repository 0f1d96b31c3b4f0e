// A cube map in one file, from the file to the colour seen along a direction.
#include <fmt/format.h>
#include <gtest/gtest.h>
// fmt first: OpenImageIO's copy of it would turn exceptions off.
#include "support/cube_map.h"

#include <atomic>

#include "core/error.h"
#include "render/environment.h"
#include "support/temp_folder.h"

namespace astrosplat {
namespace {

class CubeMapFile : public testing::Test {
  protected:
    void SetUp() override {
        params_.image = folder_ / "sky.exr";
        write_cube_map(params_.image, 8, [](int, int y) { return static_cast<float>(1 + y / 8) / 8.0f; });
    }
    TempFolder folder_;
    EnvironmentParams params_;
};

TEST_F(CubeMapFile, IsAnEnvironmentOfSixFaces) {
    const Environment environment = load_environment(params_);
    ASSERT_EQ(environment.faces->size(), 6u);
    const glm::dvec3 axes[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (int face = 0; face < 6; ++face)
        for (const double spread : {0.0, 0.1}) {
            const glm::vec3 color = sample_environment(environment, axes[face], spread);
            EXPECT_FLOAT_EQ(color.r, static_cast<float>(1 + face) / 8.0f) << face << " " << spread;
        }
}

TEST_F(CubeMapFile, IsNotOneFaceOfSix) {
    params_.cube.assign(6, params_.image);
    params_.image.clear();
    EXPECT_THROW(load_environment(params_), InputError);
}

TEST_F(CubeMapFile, LoadingCanBeCancelled) {
    const std::atomic<bool> cancelled{true};
    EXPECT_THROW(load_environment(params_, Progress{{}, &cancelled}), Cancelled);
}

}  // namespace
}  // namespace astrosplat
