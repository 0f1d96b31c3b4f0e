// transforms.json: its axes and fields of view in closed form, and what odd files end with.
#include "camera_files/formats.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "camera/camera.h"
#include "support/camera_tracks.h"

namespace astrosplat {
namespace {

class TransformsJson : public test::CameraFileTest {
  protected:
    CameraTrack read(const std::string& text) {
        return read_transforms_json(put("transforms.json", text), {});
    }
    /// Looks along +x from (1, 2, 3), z up, then once more from (4, 5, 6).
    static std::string two(const std::string& all, const std::string& own = "") {
        return "{" + all + R"("frames":[{"file_path":"a",)" + own +
               R"("transform_matrix":[[0,0,-1,1],[-1,0,0,2],[0,1,0,3],[0,0,0,1]]},{"file_path":"b",)" + own +
               R"("transform_matrix":[[0,0,-1,4],[-1,0,0,5],[0,1,0,6]]}]})";
    }
};

TEST_F(TransformsJson, HoldsRowsOfWorldFromCamera) {
    const CameraTrack track = read(two(""));
    ASSERT_EQ(track.samples.size(), 2u);
    EXPECT_EQ(track.up, FileUp::z);
    EXPECT_FALSE(track.has_fov);
    EXPECT_EQ(track.samples[1].frame, 2.0);
    EXPECT_EQ(track.samples[1].eye, glm::dvec3(4, 5, 6));
    const glm::dmat3 axes = rotation_from_quaternion(track.samples[0].rotation);
    EXPECT_LT(glm::distance(-axes[2], glm::dvec3(1, 0, 0)), 1e-12);
    EXPECT_LT(glm::distance(axes[1], glm::dvec3(0, 0, 1)), 1e-12);
    EXPECT_LT(glm::distance(axes[0], glm::dvec3(0, -1, 0)), 1e-12);
}

TEST_F(TransformsJson, FieldsOfViewAreVertical) {
    const auto fov = [&](const std::string& all, const std::string& own = "") {
        const CameraTrack track = read(two(all, own));
        EXPECT_TRUE(track.has_fov);
        return track.samples[1].fov_deg;
    };
    EXPECT_NEAR(fov(R"("fl_y":500,"fl_x":700,"w":800,"h":1000,)"), 90.0, 1e-9);
    EXPECT_NEAR(fov(R"("fl_x":500,"w":800,"h":1000,)"), 90.0, 1e-9);
    EXPECT_NEAR(fov(R"("fl_y":9,"h":9,)", R"("fl_y":500,"h":1000,)"), 90.0, 1e-9)
        << "a frame's own comes first";
    EXPECT_NEAR(fov(R"("camera_angle_y":1.0,)"), 57.29577951308232, 1e-9);
    EXPECT_NEAR(fov(R"("camera_angle_x":1.5707963267948966,)"), 90.0, 1e-9);
    EXPECT_NEAR(fov(R"("camera_angle_x":1.5707963267948966,"w":200,"h":100,)"), 53.13010235415598, 1e-9);
}

TEST_F(TransformsJson, OddFilesEndInOneLine) {
    const auto message = [&](const std::string& text) {
        return refusal("transforms.json", text, read_transforms_json);
    };
    EXPECT_EQ(message("[1]"),
              "transforms.json: expected a transforms.json with frames, found something else");
    EXPECT_EQ(message(R"({"frames":[]})"),
              "transforms.json: expected at least one of its frames, found none");
    EXPECT_EQ(
        message(R"({"frames":[{"transform_matrix":[[1,2],[3]]}]})"),
        "transforms.json: expected 3 or 4 rows of 4 numbers as transform_matrix of frame 1, found others");
    EXPECT_EQ(message(R"({"frames":[{"transform_matrix":[[0,0,0,1],[0,0,0,1],[0,0,0,1]]}]})"),
              "transforms.json: expected axes in the transform_matrix of frame 1, found none");
    EXPECT_EQ(message(two(R"("camera_angle_y":4.0,)")),
              "transforms.json: expected a field of view between 0 and 180 degrees at frame 1, found 229.2");
    EXPECT_NE(message(R"({"frames":[7]})").find("transforms.json: expected a transforms.json, found"),
              std::string::npos);
    EXPECT_NE(message(R"({"frames":[{"transform_matrix":[["x",2,3,4],[],[]]}]})")
                  .find("expected a transforms.json"),
              std::string::npos);
}

}  // namespace
}  // namespace astrosplat
