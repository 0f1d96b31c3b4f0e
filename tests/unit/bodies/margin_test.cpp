// Pictures continued beyond their edges.
#include "bodies/margin.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "source/textured_mesh.h"
#include "support/painted_picture.h"

namespace astrosplat {
namespace {

constexpr std::int64_t picture_width = 200, picture_height = 120, margin_px = 20;

TexturedMesh lit_plane(const Image& rgb) {
    TexturedMesh result;
    result.mesh = builtin_mesh("plane", static_cast<double>(rgb.width) / static_cast<double>(rgb.height));
    Texture& texture = result.textures.emplace_back();
    texture.alpha_from_light = true;
    texture.image = make_image(rgb.width, rgb.height, 4, 0.2f);
    for (std::int64_t i = 0; i < rgb.width * rgb.height; ++i)
        std::copy_n(rgb.pixels.data() + 3 * i, 3, texture.image.pixels.data() + 4 * i);
    return result;
}

Image even_light() { return make_image(picture_width, picture_height, 3, 0.2f); }

StructureParams with_margin(double margin, StructureKind kind = StructureKind::sheet) {
    StructureParams params;
    params.kind = kind;
    params.margin = margin;
    return params;
}

std::vector<TexturedMesh> continued(const Image& rgb, StructureKind kind = StructureKind::sheet) {
    std::vector<TexturedMesh> meshes{lit_plane(rgb)};
    const std::vector<glm::dvec2> times = add_margins(meshes, with_margin(0.1, kind), "a");
    EXPECT_EQ(times.size(), 1u);
    EXPECT_DOUBLE_EQ(times[0].x, 1.2);
    EXPECT_DOUBLE_EQ(times[0].y, 160.0 / 120.0);
    return meshes;
}

TEST(Margin, ThePictureStaysAsItIs) {
    const Image galaxy = painted::galaxy(picture_width, picture_height);
    const Texture texture = continued(galaxy)[0].textures[0];
    ASSERT_EQ(texture.image.width, 240);
    ASSERT_EQ(texture.image.height, 160);
    EXPECT_FALSE(texture.alpha_from_light);
    for (std::int64_t y = 0; y < picture_height; ++y) {
        for (std::int64_t x = 0; x < picture_width; ++x) {
            const float* const p = texture.image.at(x + margin_px, y + margin_px);
            ASSERT_TRUE(std::equal(p, p + 3, galaxy.at(x, y))) << x << ' ' << y;
            ASSERT_EQ(p[3], 1.0f);
        }
    }
}

TEST(Margin, FadesToNothingFromTheEdgeOutward) {
    const Texture texture = continued(even_light())[0].textures[0];
    const auto mean_at = [&](std::int64_t px_away) {  // above the picture
        double sum = 0.0;
        for (std::int64_t x = 0; x < picture_width; ++x)
            sum += texture.image.at(x + margin_px, margin_px - px_away)[1];
        return sum / picture_width;
    };
    EXPECT_NEAR(mean_at(1), 0.2, 0.02);  // no step at the edge
    for (std::int64_t px = 1; px < margin_px; ++px) EXPECT_LE(mean_at(px + 1), mean_at(px)) << px;
    EXPECT_LT(mean_at(margin_px / 2), 0.12);
    EXPECT_LT(mean_at(margin_px), 1e-3);
    for (std::int64_t i = 0; i < texture.image.width * texture.image.height; ++i) {
        const float* const p = texture.image.pixels.data() + 4 * i;
        ASSERT_NEAR(p[3], p[1] / 0.2f, 1e-5f) << i;  // light and cover fade alike
    }
}

// Of a straight outline every place as far away would be as bright.
TEST(Margin, HasARaggedOutline) {
    const Texture texture = continued(even_light())[0].textures[0];
    float least = 1.0f, most = 0.0f;
    for (std::int64_t x = picture_width / 4; x < 3 * picture_width / 4; ++x) {
        const float light = texture.image.at(x + margin_px, margin_px / 4)[1];
        least = std::min(least, light);
        most = std::max(most, light);
    }
    EXPECT_GT(most, 3.0f * least);
}

// Beyond the frame a galaxy is itself, turned in its disk's plane: as bright there as on the other side.
TEST(Margin, AGalaxyGoesOnAsItIsOnItsOtherSide) {
    for (const double inclination : {0.0, 60.0}) {
        const double ratio = std::cos(inclination * 3.14159265358979 / 180.0);
        const auto disk = [&](double x, double y) {  // its middle is far to the left
            const double u = (x - 60.0) / 70.0, v = (y - 60.0) / (70.0 * ratio);
            return static_cast<float>(std::exp(-std::sqrt(u * u + v * v)));
        };
        Image light = make_image(picture_width, picture_height, 3);
        for (std::int64_t y = 0; y < picture_height; ++y)
            for (std::int64_t x = 0; x < picture_width; ++x)
                std::fill_n(light.at(x, y), 3, disk(double(x) + 0.5, double(y) + 0.5));
        std::vector<TexturedMesh> meshes{lit_plane(light)};
        StructureParams params = with_margin(0.1, StructureKind::disk);
        params.galaxy = {inclination, 0.0, glm::dvec2(0.3, 0.5), 90.0, {}};
        add_margins(meshes, params, "a");
        const Image& image = meshes[0].textures[0].image;
        double here = 0.0, wanted = 0.0;
        for (std::int64_t y = 40; y < 120; ++y) {
            here += static_cast<double>(image.at(10, y)[1]);
            wanted += static_cast<double>(disk(10.5 - margin_px, static_cast<double>(y) + 0.5 - margin_px));
        }
        EXPECT_NEAR(here / wanted, 1.0, 0.1) << inclination;
    }
}

// Of a cloud, which does not grow dim outward, a dim rim would else end straight, and so would corners.
TEST(Margin, CloudsGoOnAllAroundAndHaveRoundCorners) {
    Image light = make_image(picture_width, picture_height, 3, 0.01f);
    for (int c = 0; c < 3; ++c) light.at(100, 0)[c] = light.at(101, 0)[c] = 9.0f;
    const Texture texture = continued(light)[0].textures[0];
    const auto lit = [&](std::int64_t x_begin, std::int64_t x_end) {
        double sum = 0.0;
        for (std::int64_t x = x_begin; x < x_end; ++x)
            for (std::int64_t y = 0; y < margin_px; ++y) sum += texture.image.at(x, y)[1] / 0.01;
        return sum / static_cast<double>((x_end - x_begin) * margin_px);
    };
    EXPECT_GT(lit(40, 100), 0.25);
    EXPECT_GT(lit(0, margin_px), 0.02);
    EXPECT_LT(lit(0, margin_px), 0.6 * lit(40, 100));
}

// A mirrored margin is brighter again towards the middle.
TEST(Margin, DoesNotGrowBrighterBeyondADimEdge) {
    Image light = make_image(picture_width, picture_height, 3, 0.0f);
    for (std::int64_t y = 0; y < picture_height; ++y)
        for (std::int64_t x = 0; x < picture_width; ++x)
            for (int c = 0; c < 3; ++c)
                light.at(x, y)[c] = 0.02f + 0.02f * static_cast<float>(std::min({x, y, picture_width - 1 - x,
                                                                                 picture_height - 1 - y}));
    const Texture texture = continued(light)[0].textures[0];
    const auto mean_at = [&](std::int64_t px_away) {  // above the picture
        double sum = 0.0;
        for (std::int64_t x = 0; x < picture_width; ++x)
            sum += static_cast<double>(texture.image.at(x + margin_px, margin_px - px_away)[1]);
        return sum / static_cast<double>(picture_width);
    };
    EXPECT_LT(mean_at(8), 2.0 * mean_at(1)) << "what is mirrored there has eight times the light of the rim";
}

TEST(Margin, AStarByTheEdgeIsNotSeenTwice) {
    Image light = even_light();
    constexpr std::int64_t star_x = 100, star_y = 3;
    for (int c = 0; c < 3; ++c) light.at(star_x, star_y)[c] = 50.0f;
    const Texture texture = continued(light)[0].textures[0];
    const float there = texture.image.at(star_x + margin_px, margin_px - 1 - star_y)[1];
    const float beside = texture.image.at(star_x + margin_px + 8, margin_px - 1 - star_y)[1];
    EXPECT_GT(there, 0.5f * beside);
    EXPECT_LT(there, 4.0f * beside) << "250 times as bright in the picture";
}

TEST(Margin, ACameraSeesThePictureWhereItWas) {
    std::vector<TexturedMesh> meshes{lit_plane(even_light())};
    UvCamera params;
    params.position = glm::dvec3(0.0, 8.0, 0.0);
    params.up = {0.0, 0.0, -1.0};
    params.fov = 40.0;
    const Camera before = picture_camera(params, 200.0 / 120.0);
    meshes[0].camera = before;
    apply_camera_uv(meshes[0].mesh, before);
    const glm::dvec2 times = add_margins(meshes, with_margin(0.1), "a")[0];
    for (const glm::dvec3& point : {glm::dvec3(0, 0, 0), {4.9, 0, -2.9}, {-2, 1, 1}}) {
        const glm::dvec2 was = place_in_picture(before, point)->uv;
        const glm::dvec2 is = place_in_picture(*meshes[0].camera, point)->uv;
        for (int k = 0; k < 2; ++k) EXPECT_NEAR((is[k] - 0.5) * times[k] + 0.5, was[k], 1e-12);
    }
    EXPECT_NEAR(picture_height_at(*meshes[0].camera, 8.0), times.y * picture_height_at(before, 8.0), 1e-12);
}

TEST(Margin, OtherMeshesStay) {
    std::vector<TexturedMesh> meshes{lit_plane(even_light())};
    meshes[0].mesh = builtin_mesh("sphere", 1.0);
    EXPECT_EQ(add_margins(meshes, with_margin(0.1), "a")[0], glm::dvec2(1.0));
    EXPECT_EQ(meshes[0].textures[0].image.width, picture_width);
    meshes[0].mesh = builtin_mesh("plane", 1.0);
    EXPECT_EQ(add_margins(meshes, with_margin(0.0), "a")[0], glm::dvec2(1.0));
    EXPECT_EQ(meshes[0].textures[0].image.width, picture_width);
}

}  // namespace
}  // namespace astrosplat
