#include "bodies/choose.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bodies/picture_light.h"
#include "source/texture.h"
#include "support/painted_picture.h"
#include "support/printing.h"
#include "support/test_data.h"

namespace astrosplat {
namespace {

TEST(ChooseStructure, TellsPaintedObjectsApart) {
    for (const std::int64_t width : {400, 900}) {
        EXPECT_EQ(choose_structure(painted::galaxy(width, width * 5 / 8)).kind, StructureKind::disk)
            << width << choose_structure(painted::galaxy(width, width * 5 / 8)).why;
        EXPECT_EQ(choose_structure(painted::nebula(width, width * 5 / 8)).kind, StructureKind::walls)
            << width;
        EXPECT_EQ(choose_structure(painted::remnant(width, width * 5 / 8)).kind, StructureKind::walls)
            << width;
    }
}

// A kind that is given is not looked for; a nebula is a shell where it stands alone, and a sheet where it
// does not.
TEST(ChooseStructure, TakesAPictureForWhatItIsSaidToShow) {
    const Image remnant = painted::remnant(400, 250), even = make_image(400, 250, 3, 0.3f);
    for (const Image& light : {remnant, even}) {
        EXPECT_EQ(choose_structure(light, SkyObject::galaxy).kind, StructureKind::disk);
        EXPECT_EQ(choose_structure(light, SkyObject::remnant).kind, StructureKind::walls);
        EXPECT_EQ(choose_structure(light, SkyObject::nebula).why, "");
    }
    EXPECT_EQ(choose_structure(remnant, SkyObject::nebula).kind, StructureKind::walls);
    EXPECT_EQ(choose_structure(even, SkyObject::nebula).kind, StructureKind::sheet);
    EXPECT_EQ(choose_structure(make_image(8, 8, 3, 0.3f), SkyObject::nebula).kind, StructureKind::sheet);
}

TEST(ChooseStructure, SaysWhy) {
    EXPECT_NE(choose_structure(painted::galaxy(400, 250)).why.find("middle"), std::string::npos);
    EXPECT_NE(choose_structure(make_image(400, 250, 3, 0.3f)).why.find("edges"), std::string::npos);
    EXPECT_NE(choose_structure(make_image(8, 8, 3, 0.3f)).why.find("small"), std::string::npos);
}

// Grey or, with `blue` below 1, warm, with a bright middle and a tail to one side; `sides` 2: to both.
Image tailed(int sides, float blue = 1.0f) {
    Image light = make_image(400, 250, 3);
    for (std::int64_t y = 0; y < light.height; ++y) {
        for (std::int64_t x = 0; x < light.width; ++x) {
            const auto u = static_cast<float>(x - 200), v = static_cast<float>(y - 125);
            const bool in_tail = u > 0.0f || sides == 2;
            const float tail = in_tail ? 0.2f * std::exp(-std::fabs(u) / 50.0f - v * v / 3000.0f) : 0.0f;
            std::fill_n(light.at(x, y), 3, tail + 0.6f * std::exp(-(u * u + v * v) / 60.0f));
            light.at(x, y)[2] *= blue;
        }
    }
    return light;
}

TEST(ChooseStructure, InGreyTheShapeTellsAGalaxyFromACloud) {
    EXPECT_EQ(choose_structure(tailed(2)).kind, StructureKind::disk) << choose_structure(tailed(2)).why;
    EXPECT_EQ(choose_structure(tailed(1)).kind, StructureKind::walls);
    EXPECT_EQ(choose_structure(tailed(1)).object, SkyObject::nebula);
    EXPECT_NE(choose_structure(tailed(1)).why.find("either side"), std::string::npos)
        << choose_structure(tailed(1)).why;
}

TEST(ChooseStructure, InColourTheShapeTellsToo) {
    EXPECT_EQ(choose_structure(tailed(2, 0.8f)).kind, StructureKind::disk);
    EXPECT_EQ(choose_structure(tailed(1, 0.8f)).kind, StructureKind::walls);
}

// A round middle of light 1 in a wide glow of light `wide`, each of its own colour.
Image glowing(const glm::vec3& middle, const glm::vec3& around, float wide = 0.2f) {
    Image light = make_image(400, 250, 3);
    for (std::int64_t y = 0; y < light.height; ++y) {
        for (std::int64_t x = 0; x < light.width; ++x) {
            const auto u = static_cast<float>(x - 200), v = static_cast<float>(y - 125);
            const float near = std::exp(-(u * u + v * v) / 200.0f),
                        far = wide * std::exp(-(u * u + v * v) / 4000.0f);
            for (int c = 0; c < 3; ++c) light.at(x, y)[c] = near * middle[c] + far * around[c];
        }
    }
    return light;
}

TEST(ChooseStructure, TellsLightOfGasFromThatOfStars) {
    const glm::vec3 warm(1.0f, 0.85f, 0.65f), blue(0.7f, 0.85f, 1.0f), white(1.0f);
    EXPECT_EQ(choose_structure(glowing(warm, blue)).kind, StructureKind::disk);
    EXPECT_EQ(choose_structure(glowing(warm, warm)).kind, StructureKind::disk);
    EXPECT_EQ(choose_structure(glowing({0.8f, 0.45f, 0.2f}, {0.8f, 0.45f, 0.25f})).kind, StructureKind::disk)
        << "stars behind dust";
    const glm::vec3 hydrogen(1.0f, 0.2f, 0.3f), pink(1.0f, 0.55f, 0.8f), oxygen(0.2f, 1.0f, 0.9f);
    for (const glm::vec3& gas : {hydrogen, pink, oxygen}) {
        const StructureChoice choice = choose_structure(glowing(gas, gas));
        EXPECT_EQ(choice.kind, StructureKind::walls) << gas.g;
        EXPECT_EQ(choice.object, SkyObject::nebula) << gas.g;
        EXPECT_NE(choice.why.find("gas"), std::string::npos) << choice.why;
    }
    EXPECT_EQ(choose_structure(glowing(white, {1.0f, 0.8f, 0.55f})).kind, StructureKind::disk)
        << "a round middle, burnt out to white";
    EXPECT_EQ(choose_structure(glowing(blue, {1.0f, 0.75f, 0.3f})).kind, StructureKind::walls)
        << "a middle that is truly bluer";
}

// Many spirals have no more than a small, dim bulge.
TEST(ChooseStructure, TakesAnEvenDiskWithADimButRedderMiddleForAGalaxy) {
    const glm::vec3 warm(0.6f, 0.4f, 0.2f), blue(0.75f, 0.85f, 1.0f);
    EXPECT_EQ(choose_structure(glowing(warm, blue, 0.8f)).kind, StructureKind::disk);
    EXPECT_EQ(choose_structure(glowing(blue * 0.5f, blue, 0.8f)).kind, StructureKind::walls);
}

// Galaxies and stars on a dark sky; as one cloud of wide light they would be none.
TEST(ChooseStructure, TellsAFieldOfManyThings) {
    const auto strewn = [](double sigma) {
        Image light = make_image(600, 400, 3, 0.004f);
        for (std::uint32_t i = 0; i < 160; ++i)
            painted::add_point(light, painted::random(i, 1) * 600.0, painted::random(i, 2) * 400.0,
                               sigma * (0.5 + painted::random(i, 3)), 0.1 + 0.3 * painted::random(i, 4), 0.25,
                               0.3);
        return light;
    };
    const StructureChoice field = choose_structure(strewn(2.5));
    EXPECT_EQ(field.object, SkyObject::field) << field.why;
    EXPECT_EQ(field.kind, StructureKind::sheet);
    EXPECT_NE(choose_structure(strewn(25.0)).object, SkyObject::field);
    EXPECT_NE(choose_structure(painted::galaxy(600, 400)).object, SkyObject::field);
    EXPECT_EQ(choose_structure(painted::galaxy(600, 400), SkyObject::field).kind, StructureKind::sheet);
}

StructureChoice choice_of(const std::filesystem::path& file) {
    const Texture texture = load_texture({file}, {}, TextureSettings::Wrap::clamp);
    return choose_structure(picture_light(texture, 0.0).light);
}
StructureKind chosen(const std::filesystem::path& file) { return choice_of(file).kind; }
SkyObject object_in(const std::filesystem::path& file) { return choice_of(file).object; }

TEST(ChooseStructure, TellsRealGreyObjectsApart) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(fits, "fits");
    EXPECT_EQ(chosen(fits / "w5_wise.fits"), StructureKind::walls);
    EXPECT_EQ(chosen(fits / "m51_b_kpno.fits"), StructureKind::disk);
}

TEST(ChooseStructure, TellsRealObjectsApart) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(images, "images");
    EXPECT_EQ(object_in(images / "hubble_deep_field.jpg"), SkyObject::field);
    EXPECT_EQ(object_in(images / "m42.png"), SkyObject::nebula);
    EXPECT_EQ(chosen(images / "m101_heic0602a.jpg"), StructureKind::disk);
    EXPECT_EQ(chosen(images / "heic0706a.jpg"), StructureKind::disk);
    EXPECT_EQ(chosen(images / "heic1305a.jpg"), StructureKind::disk);
    EXPECT_EQ(chosen(images / "red_spider_heic0109a.jpg"), StructureKind::walls);
    EXPECT_EQ(chosen(images / "m42.png"), StructureKind::walls);
    EXPECT_EQ(chosen(images / "heic1501a.jpg"), StructureKind::sheet);
    EXPECT_EQ(chosen(images / "heic0515a.jpg"), StructureKind::walls);
    EXPECT_EQ(chosen(images / "heic1310a.jpg"), StructureKind::walls);
}

// Of wide light: a bright star is none.
TEST(Choose, SubjectIsWhereWideLightIsBrightest) {
    Image light = make_image(640, 400, 3, 0.02f);
    painted::add_point(light, 160.0, 300.0, 30.0, 0.4, 0.3, 0.2);
    painted::add_point(light, 500.0, 100.0, 1.2, 0.9, 0.9, 0.9);
    const glm::dvec2 subject = subject_of(light);
    EXPECT_NEAR(subject.x, 0.25, 0.02);
    EXPECT_NEAR(subject.y, 0.75, 0.02);
    EXPECT_EQ(subject_of(make_image(8, 8, 3, 1.0f)), glm::dvec2(0.5));
    EXPECT_EQ(subject_of(make_image(64, 40, 3)), glm::dvec2(0.5));
}

}  // namespace
}  // namespace astrosplat
