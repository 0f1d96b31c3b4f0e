// prepare --align: stars of one field, seen by two telescopes, come to lie on each other.
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "prepare/filters.h"
#include "scene_fixture.h"
#include "source/texture.h"
#include "support/fits_text.h"

namespace astrosplat::test {
namespace {

constexpr double ra = 202.47, dec = 47.2;  // degrees: the middle of the field
constexpr double star_sigma = 0.0005;      // degrees

// A telescope that sees the field: its picture's size, how many degrees a pixel covers, how it is turned.
struct Telescope {
    int width, height;
    double scale, turn_deg;

    std::string sky() const {
        return fits_sky(width / 2.0 + 3.0, height / 2.0 - 5.0, ra + 0.002, dec - 0.001, scale, turn_deg);
    }
    TanGrid grid() const {
        const double c = scale * std::cos(turn_deg * 3.14159265358979323846 / 180.0);
        const double s = scale * std::sin(turn_deg * 3.14159265358979323846 / 180.0);
        return {{width / 2.0 + 3.0, height / 2.0 - 5.0}, {ra + 0.002, dec - 0.001}, {-c, s, s, c}};
    }
};

// Places of the sky around the middle, degrees.
std::vector<glm::dvec2> field() {
    std::vector<glm::dvec2> stars;
    for (int i = 0; i < 36; ++i) {
        const double u = (i % 6 - 2.5) * 0.008 + 0.0017 * std::sin(3.0 * i),
                     v = (i / 6 - 2.5) * 0.008 + 0.0017 * std::cos(5.0 * i);
        stars.emplace_back(ra + u / std::cos(dec * 3.14159265358979323846 / 180.0), dec + v);
    }
    return stars;
}

// The field as a telescope sees it: Gaussian stars on a little noise.
std::string picture_by(const Telescope& telescope) {
    std::vector<glm::dvec2> places;
    for (const glm::dvec2& star : field())
        if (const auto place = place_of(telescope.grid(), star)) places.push_back(*place);
    const double sigma = star_sigma / telescope.scale;
    return fits_file(telescope.width, telescope.height, telescope.sky(), [&](int x, int y) {
        double light = 100.0 + (x * 7 + y * 13) % 5;
        for (const glm::dvec2& place : places) {
            const double dx = x + 1.0 - place.x, dy = y + 1.0 - place.y;
            light += 800.0 * std::exp(-(dx * dx + dy * dy) / (2.0 * sigma * sigma));
        }
        return light;
    });
}

class PrepareAlign : public SceneTest {
  protected:
    // The middle of the light around a place, px from the top left corner.
    static glm::dvec2 centroid(const Image& image, const glm::dvec2& about, double reach) {
        double sum = 0.0;
        glm::dvec2 moment(0.0);
        for (auto y = static_cast<std::int64_t>(about.y - reach);
             y <= static_cast<std::int64_t>(about.y + reach); ++y)
            for (auto x = static_cast<std::int64_t>(about.x - reach);
                 x <= static_cast<std::int64_t>(about.x + reach); ++x) {
                const glm::dvec2 middle(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5);
                const double light = std::max(0.0, static_cast<double>(image.at(x, y)[0]) - 0.1);
                sum += light;
                moment += light * middle;
            }
        return moment / sum;
    }

    // Aligns the picture of `own` with that of `reference`, and compares its stars with where the field lies.
    void expect_aligned(const Telescope& own, const Telescope& reference) const {
        write_text(folder / "own.fits", picture_by(own));
        write_text(folder / "reference.fits", picture_by(reference));
        const RunResult result =
            run({"prepare", "own.fits", "--align", "reference.fits", "-o", "out", "--overwrite", "--stars",
                 "keep", "--stretch", "linear", "--white", "1000", "--black", "100"});
        ASSERT_EQ(result.code, 0) << result.err;
        const std::string size = fmt::format("{}x{} px", reference.width, reference.height);
        EXPECT_NE(result.out.find(size), std::string::npos) << result.out;
        const Image picture = load_linear_image(folder / "out/picture.exr");
        const double reach = 3.0 * star_sigma / reference.scale;
        int seen = 0;
        double farthest = 0.0;
        for (const glm::dvec2& star : field()) {
            const glm::dvec2 px = place_of(reference.grid(), star).value();
            const glm::dvec2 place(px.x - 0.5, reference.height + 0.5 - px.y);  // from the top left corner
            const glm::dvec2 inside = glm::min(place, glm::dvec2(reference.width, reference.height) - place);
            const glm::dvec2 own_px = place_of(own.grid(), star).value();
            const glm::dvec2 own_inside = glm::min(own_px, glm::dvec2(own.width, own.height) - own_px);
            const double own_reach = 3.0 * star_sigma / own.scale + 3.0;
            if (std::min(inside.x, inside.y) < reach + 2.0 ||
                std::min(own_inside.x, own_inside.y) < own_reach)
                continue;
            ++seen;
            farthest = std::max(farthest, glm::distance(centroid(picture, place, reach), place));
        }
        EXPECT_GE(seen, 30);
        EXPECT_LE(farthest, 0.3);
        RecordProperty(fmt::format("farthest_px_{}", reference.width), fmt::format("{:.3f}", farthest));
    }
};

TEST_F(PrepareAlign, AcrossAScaleOfThreeAndARotation) {
    const Telescope fine{420, 400, 0.00015, 33.0}, coarse{150, 140, 0.00045, -20.0};
    expect_aligned(fine, coarse);
    expect_aligned(coarse, fine);
}

TEST_F(PrepareAlign, WhatTheOtherDoesNotShowIsEmpty) {
    const Telescope small{100, 100, 0.00015, 10.0}, large{300, 300, 0.00015, 0.0};
    write_text(folder / "own.fits", picture_by(small));
    write_text(folder / "reference.fits", picture_by(large));
    const RunResult result =
        run({"prepare", "own.fits", "--align", "reference.fits", "-o", "out", "--stars", "keep"});
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.out.find("300x300 px, linear light, alpha"), std::string::npos) << result.out;
}

TEST_F(PrepareAlign, NeedsTheSkyOnBoth) {
    const auto dark = [](int, int) { return 1.0; };
    write_text(folder / "plain.fits", fits_file(40, 30, "", dark));
    write_text(folder / "sky.fits", fits_file(40, 30, fits_sky(20, 15, ra, dec, 0.001, 0.0), dark));
    const auto refused = [&](const char* own, const char* reference, const char* named) {
        const RunResult result =
            run({"prepare", own, "--align", reference, "-o", "out", "--progress", "none"});
        expect_one_line(
            result, 2,
            std::string(named) + ": expected a FITS picture whose header tells the sky (RA---TAN)");
    };
    refused("plain.fits", "sky.fits", "plain.fits");
    refused("sky.fits", "plain.fits", "plain.fits");
    expect_one_line(run({"prepare", "sky.fits", "--align", "missing.fits", "-o", "out"}), 2, "missing.fits");
}

}  // namespace
}  // namespace astrosplat::test
