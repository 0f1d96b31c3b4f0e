// Captures with colours by direction, baked and written and read again: the same colours in all directions
// where nothing changed them, and those of the frame in the direction it is seen from where something did.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>

#include "core/color.h"
#include "core/real.h"
#include "core/rotation.h"
#include "gaussians/gaussian_file.h"
#include "gaussians/gaussians.h"
#include "splat_files/splat_file.h"
#include "splats/harmonics.h"
#include "support/bits.h"
#include "support/capture.h"
#include "support/temp_folder.h"

namespace astrosplat::test {
namespace {

glm::vec3 linear(glm::vec3 color) {
    for (int k = 0; k < 3; ++k) color[k] = static_cast<float>(real::srgb_to_linear(color[k]));
    return color;
}

/// The linear light of row i in a direction.
glm::vec3 light_of(const SplatSet& set, std::size_t i, const glm::dvec3& direction) {
    if (set.harmonics.empty()) return set.color[i];
    const glm::vec3 color = color_towards(set.harmonics[i], glm::vec3(direction));
    return set.display_harmonics ? linear(color) : color;
}

/// A capture as a frame shows it: its light as the camera sees it, times `factor`.
struct SeenCapture {
    TempFolder folder;
    SplatSet set;
    ShadedSplats splats;
    RenderLayer layer;
    Camera camera;
    glm::vec3 factor{1.0f};

    explicit SeenCapture(const std::string& name, const std::string& bytes)
        : set(read_splats(folder.file(name, bytes))) {
        camera.eye = {1.0, 2.0, 9.0};
        layer.gaussians = true;
        if (!set.harmonics.empty()) layer.directional = &set;
    }
    glm::dvec3 place(std::size_t i) const {
        return layer.world_from_layer * (layer.scale * glm::dvec3(set.position[i])) + layer.translate;
    }
    /// In the layer's axes.
    glm::dvec3 to_camera(std::size_t i) const {
        return glm::transpose(layer.world_from_layer) * glm::normalize(place(i) - camera.eye);
    }
    Gaussians baked(bool encoded) {
        splats = {};
        for (std::size_t i = 0; i < set.position.size(); ++i) {
            if (i % 7 == 3) continue;  // what a look leaves out
            splats.position.push_back(set.position[i]);
            splats.color.push_back(factor * light_of(set, i, to_camera(i)));
            splats.alpha.push_back(set.alpha[i]);
            splats.radius.push_back(set.radius[i]);
            splats.id.push_back(set.id[i]);
            splats.stretch.push_back(glm::mat3(0.3f));
        }
        layer.splats = &splats;
        Gaussians gaussians;
        BakeCounts counts;
        bake_layer(layer, camera, 1.0, gaussians, counts);
        if (encoded) encode_for_display(gaussians);
        finish_harmonics(gaussians, camera, encoded);
        return gaussians;
    }
    SplatSet again(const Gaussians& gaussians, const std::string& name, bool encoded) {
        const std::filesystem::path file = folder / name;
        if (name.ends_with(".ply"))
            write_gaussian_ply({file, Existing::replace}, gaussians);
        else if (name.ends_with(".usda"))
            write_gaussian_usda({file, Existing::replace}, gaussians);
        else
            write_gaussian_glb({file, Existing::replace}, gaussians, encoded);
        return read_splats(file);
    }
    std::size_t row(std::size_t kept) const { return kept + (kept + 3) / 6; }
};

constexpr int directions = 24;
glm::dvec3 direction(int n) {
    const double z = 1.0 - 2.0 * (n + 0.5) / directions, r = std::sqrt(1.0 - z * z);
    return {r * real::cos(2.4 * n), r * real::sin(2.4 * n), z};
}

/// Differences of colours over all directions, as a display shows them; of channels that the camera sees
/// bright enough to tell what became of them.
struct Differences {
    double largest = 0.0, mean = 0.0;  // root of the mean square
};
Differences differences(const SeenCapture& capture, const SplatSet& found, double bright = 0.0) {
    Differences d;
    double squares = 0.0, count = 0.0;
    for (std::size_t i = 0; i < found.position.size(); ++i) {
        const std::size_t row = capture.row(i);
        const glm::vec3 seen = light_of(capture.set, row, capture.to_camera(row));
        for (int n = 0; n < directions; ++n) {
            const glm::vec3 wanted = capture.factor * light_of(capture.set, row, direction(n)),
                            is = light_of(found, i, capture.layer.world_from_layer * direction(n));
            for (int k = 0; k < 3; ++k) {
                if (double(seen[k]) < bright) continue;
                const double off = std::fabs(real::linear_to_srgb(is[k]) - real::linear_to_srgb(wanted[k]));
                d.largest = std::max(d.largest, off);
                squares += off * off;
                ++count;
            }
        }
    }
    d.mean = std::sqrt(squares / count);
    return d;
}

TEST(HarmonicsExport, CapturesComeOutWithTheColoursThatTheyCameWith) {
    for (const int degree : {0, 1, 2, 3}) {
        SeenCapture capture("in.ply", ply_of(test::capture(60, degree), degree));
        capture.layer.world_from_layer = rotation_from_degrees({20.0, 130.0, 40.0});
        capture.layer.scale = 2.0;
        const Gaussians gaussians = capture.baked(true);
        EXPECT_EQ(gaussians.degree, degree);
        for (const char* name : {"out.ply", "out.glb", "out.usda"}) {
            const SplatSet found = capture.again(gaussians, name, true);
            ASSERT_EQ(found.position.size(), 51u);
            EXPECT_EQ(found.harmonics.empty(), degree == 0);
            EXPECT_LT(differences(capture, found).largest, 1e-4) << degree << " " << name;
        }
        const std::string header = bytes_of(capture.folder / "out.ply");
        const int rest = 3 * ((degree + 1) * (degree + 1) - 1);
        const auto has = [&](int n) {
            return header.find("property float f_rest_" + std::to_string(n) + "\n") != std::string::npos;
        };
        EXPECT_TRUE(rest == 0 || has(rest - 1));
        EXPECT_FALSE(has(rest));
    }
}

// Converted light is exact in the direction of view; where both spaces are linear, in every direction.
TEST(HarmonicsExport, WhatTheLookDoesIsDoneToAllDirections) {
    SeenCapture linear_one("in.glb", glb_of(test::capture(60, 3), 3, "", "lin_rec709_display"));
    linear_one.factor = {0.5f, 0.25f, 0.8f};
    const SplatSet linear_found = linear_one.again(linear_one.baked(false), "out.glb", false);
    EXPECT_LT(differences(linear_one, linear_found, 0.05).largest, 1e-3);

    SeenCapture capture("in.ply", ply_of(test::capture(60, 3), 3));
    capture.factor = {0.5f, 0.25f, 0.8f};
    const SplatSet found = capture.again(capture.baked(true), "out.ply", true);
    for (std::size_t i = 0; i < found.position.size(); ++i) {
        const glm::dvec3 seen = capture.to_camera(capture.row(i));
        const glm::vec3 wanted = capture.factor * light_of(capture.set, capture.row(i), seen),
                        is = light_of(found, i, seen);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(is[k], wanted[k], 1e-4) << i;
    }
    EXPECT_LT(differences(capture, found, 0.05).mean, 0.03);
}

TEST(HarmonicsExport, DisplayValuesBecomeLinearLight) {
    SeenCapture capture("in.ply", ply_of(test::capture(60, 3), 3));
    const SplatSet found = capture.again(capture.baked(false), "out.glb", false);
    EXPECT_FALSE(found.display_harmonics);
    EXPECT_LT(differences(capture, found).mean, 0.05);
}

// Splats beside a capture have their colour from everywhere, and what has no directions no file tells of.
TEST(HarmonicsExport, OthersKeepTheirColour) {
    SeenCapture capture("in.ply", ply_of(test::capture(60, 1), 1));
    RenderLayer plain;
    ShadedSplats one;
    one.position.push_back({1.0f, 0.0f, 0.0f});
    one.color.push_back({0.3f, 0.2f, 0.1f});
    one.alpha.push_back(0.5f);
    one.radius.push_back(0.1f);
    one.id.push_back(0);
    plain.splats = &one;
    Gaussians gaussians;
    BakeCounts counts;
    bake_layer(plain, capture.camera, 1.0, gaussians, counts);
    capture.baked(true);
    bake_layer(capture.layer, capture.camera, 1.0, gaussians, counts);
    bake_layer(plain, capture.camera, 1.0, gaussians, counts);
    finish_harmonics(gaussians, capture.camera, false);
    const SplatSet found = capture.again(gaussians, "out.glb", false);
    ASSERT_EQ(found.position.size(), 53u);
    for (const std::size_t i : {std::size_t{0}, std::size_t{52}})
        for (int n = 0; n < directions; ++n)
            EXPECT_LT(glm::length(light_of(found, i, direction(n)) - one.color[0]), 1e-5f) << i;
}

}  // namespace
}  // namespace astrosplat::test
