// Crops against their closed forms: what is kept, and the opacity within their soft edges.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/error.h"
#include "support/errors.h"
#include "unit/look/sets.h"

namespace astrosplat {
namespace {

/// Alpha 1 after the crops, at a place of the layer; 0: dropped.
float left_at(const glm::vec3& place, const std::vector<Crop>& crops) {
    SplatSet set = test::one_splat(0.0f, 1.0f, 1.0f);
    set.position[0] = place;
    Look look;
    look.crop = crops;
    const ShadedSplats shaded = test::shade(set, look);
    return shaded.size() == 0 ? 0.0f : shaded.alpha[0];
}

Crop box_of(const glm::vec3& center, const glm::vec3& size) {
    Crop crop;
    crop.center = center;
    crop.size = size;
    return crop;
}

Crop sphere_of(const glm::vec3& center, float radius) {
    Crop crop;
    crop.shape = Crop::Shape::sphere;
    crop.center = center;
    crop.radius = radius;
    return crop;
}

float smooth(float t) { return t * t * (3.0f - 2.0f * t); }

TEST(Crop, ABoxKeepsWhatLiesInIt) {
    const Crop box = box_of({1.0f, 2.0f, 3.0f}, {2.0f, 4.0f, 6.0f});
    EXPECT_EQ(left_at({1.0f, 2.0f, 3.0f}, {box}), 1.0f);
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.0f, 1.0f}) {
            glm::vec3 place = box.center;
            place[axis] += side * 0.5f * box.size[axis];
            EXPECT_EQ(left_at(place, {box}), 1.0f) << "its surface is inside";
            place[axis] += side * 0.001f;
            EXPECT_EQ(left_at(place, {box}), 0.0f);
        }
}

TEST(Crop, ASphereKeepsWhatLiesInIt) {
    const Crop sphere = sphere_of({1.0f, 0.0f, -1.0f}, 5.0f);
    EXPECT_EQ(left_at({4.0f, 4.0f, -1.0f}, {sphere}), 1.0f);
    EXPECT_EQ(left_at({4.0f, 4.01f, -1.0f}, {sphere}), 0.0f);
    EXPECT_EQ(left_at({1.0f, 0.0f, -6.01f}, {sphere}), 0.0f);
}

TEST(Crop, OpacityFallsOverTheSoftEdge) {
    Crop box = box_of({0.0f, 0.0f, 0.0f}, {4.0f, 4.0f, 4.0f});
    Crop sphere = sphere_of({0.0f, 0.0f, 0.0f}, 2.0f);
    box.soft = sphere.soft = 0.8f;
    for (const Crop& crop : {box, sphere}) {
        EXPECT_EQ(left_at({1.6f, 0.0f, 0.0f}, {crop}), 1.0f);
        EXPECT_NEAR(left_at({1.8f, 0.0f, 0.0f}, {crop}), smooth(0.75f), 1e-6f);
        EXPECT_NEAR(left_at({2.0f, 0.0f, 0.0f}, {crop}), 0.5f, 1e-6f);
        EXPECT_NEAR(left_at({0.0f, -2.2f, 0.0f}, {crop}), smooth(0.25f), 1e-6f);
        EXPECT_EQ(left_at({0.0f, 0.0f, 2.4f}, {crop}), 0.0f);
    }
}

/// Beside an edge and a corner the distance is that from these.
TEST(Crop, TheSoftEdgeOfABoxIsRound) {
    Crop box = box_of({0.0f, 0.0f, 0.0f}, {2.0f, 2.0f, 2.0f});
    box.soft = 2.0f;
    EXPECT_NEAR(left_at({1.3f, 1.4f, 0.0f}, {box}), smooth(0.25f), 1e-6f);
    const float each = 0.5f / std::sqrt(3.0f);
    EXPECT_NEAR(left_at(glm::vec3(1.0f + each), {box}), smooth(0.25f), 1e-5f);
}

TEST(Crop, OutsideIsTheRest) {
    for (const float soft : {0.0f, 1.0f})
        for (Crop crop :
             {box_of({0.0f, 0.0f, 0.0f}, {2.0f, 2.0f, 2.0f}), sphere_of({0.0f, 0.0f, 0.0f}, 1.0f)}) {
            crop.soft = soft;
            Crop rest = crop;
            rest.keep = Crop::Keep::outside;
            for (const float x : {0.0f, 0.6f, 0.9f, 1.0f, 1.2f, 1.6f})
                EXPECT_NEAR(left_at({x, 0.0f, 0.0f}, {crop}) + left_at({x, 0.0f, 0.0f}, {rest}), 1.0f, 1e-6f)
                    << x;
        }
}

TEST(Crop, ABoxIsTurnedAboutItsCentre) {
    Crop box = box_of({10.0f, 0.0f, 0.0f}, {4.0f, 1.0f, 1.0f});
    box.rotate = {0.0f, 0.0f, 90.0f};
    EXPECT_EQ(left_at({10.0f, 1.9f, 0.0f}, {box}), 1.0f);
    EXPECT_EQ(left_at({11.9f, 0.0f, 0.0f}, {box}), 0.0f);
    box.rotate = {0.0f, 0.0f, 45.0f};
    EXPECT_EQ(left_at({11.3f, 1.3f, 0.0f}, {box}), 1.0f);
    EXPECT_EQ(left_at({11.3f, -1.3f, 0.0f}, {box}), 0.0f);
}

TEST(Crop, OfSeveralAllHold) {
    Crop wide = box_of({0.0f, 0.0f, 0.0f}, {4.0f, 4.0f, 4.0f}), hole = sphere_of({0.0f, 0.0f, 0.0f}, 1.0f);
    hole.keep = Crop::Keep::outside;
    EXPECT_EQ(left_at({0.5f, 0.0f, 0.0f}, {wide, hole}), 0.0f);
    EXPECT_EQ(left_at({1.5f, 0.0f, 0.0f}, {wide, hole}), 1.0f);
    EXPECT_EQ(left_at({2.5f, 0.0f, 0.0f}, {wide, hole}), 0.0f);
    wide.soft = hole.soft = 2.0f;
    EXPECT_NEAR(left_at({1.5f, 0.0f, 0.0f}, {wide, hole}), smooth(0.75f) * smooth(0.75f), 1e-6f);
}

TEST(Crop, DustFadesToo) {
    SplatSet set = test::one_splat(0.0f, 0.6f, -1.0f);
    set.absorbs = true;
    Look look;
    look.crop = {box_of(set.position[0] + glm::vec3(1.0f, 0.0f, 0.0f), {2.0f, 9.0f, 9.0f})};
    look.crop[0].soft = 0.5f;
    EXPECT_NEAR(test::shade(set, look).alpha.at(0), 0.3f, 1e-6f);
    EXPECT_EQ(test::shade(set, look).color.at(0).x, -1.0f);
}

TEST(Crop, OneThatCutsNothingChangesNoBit) {
    const SplatSet set = test::file_set(3000);
    Look look;
    const ShadedSplats before = test::shade(set, look);
    look.crop = {box_of({0.0f, 0.0f, 0.0f}, glm::vec3(100.0f))};
    const ShadedSplats after = test::shade(set, look);
    ASSERT_EQ(after.size(), before.size());
    EXPECT_EQ(std::memcmp(after.alpha.data(), before.alpha.data(), before.alpha.size() * sizeof(float)), 0);
}

TEST(Crop, MoreThanEightAreRefused) {
    Look look;
    look.crop.resize(9);
    EXPECT_EQ(message_of<InputError>([&] { test::shade(test::file_set(1), look); }),
              "look.crop: expected at most 8 crops, found 9");
}

}  // namespace
}  // namespace astrosplat
