// "Did you mean": distances worked out by hand, and the slips people make in keys.
#include "scene/parameter_key.h"

#include <gtest/gtest.h>

#include <vector>

namespace astrosplat {
namespace {

TEST(Suggest, EditDistance) {
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
    EXPECT_EQ(edit_distance("", "abc"), 3);
    EXPECT_EQ(edit_distance("same", "same"), 0);
    EXPECT_EQ(edit_distance("outptu", "output"), 1);
    EXPECT_EQ(edit_distance("uotput", "output"), 1);
}

TEST(Suggest, NearestName) {
    const std::vector<std::string> keys{"layer.look.alpha.power", "layer.look.density", "camera.fov"};
    EXPECT_EQ(nearest_name("camera.fow", keys), "camera.fov");
    EXPECT_EQ(nearest_name("alpha.powr", keys), "layer.look.alpha.power");
    EXPECT_EQ(nearest_name("densty", keys), "layer.look.density");
    EXPECT_EQ(nearest_name("fow", keys), "camera.fov");
    EXPECT_EQ(nearest_name("something", keys), "");
}

}  // namespace
}  // namespace astrosplat
