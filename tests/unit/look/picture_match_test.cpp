// match = "picture": a screened column shows the picture's light and not more, and cells of the picture keep
// their light however few of their positions become splats.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/parallel.h"
#include "core/real.h"
#include "unit/look/sets.h"

namespace astrosplat {
namespace {

constexpr double slab_half = 1.6, slab_spacing = 0.08, slab_distance = 0.4;
constexpr float slab_alpha = 0.7f;
const glm::vec3 slab_color{0.9f, 0.4f, 0.1f};

SplatSet colored_slab(double spacing = slab_spacing) {
    SplatSet set = test::slab(spacing, slab_half, slab_distance, slab_alpha);
    for (glm::vec3& c : set.color) c = slab_color;
    for (const glm::vec3& p : set.position)
        set.uv.emplace_back(0.5 + double(p.x) / (2.0 * slab_half), 0.5 + double(p.z) / (2.0 * slab_half));
    return set;
}

Look picture_look(VerticalAlpha::Match match = VerticalAlpha::Match::picture) {
    Look look;
    look.radius = {0.15f, 0.15f, 1.0f, 1.0f};
    look.vertical.match = match;
    return look;
}

LookInputs picture_inputs(ColumnLaw law) {
    LookInputs inputs;
    inputs.falloff_integral = real::pi / 3.0;  // of 1 - t
    inputs.column = law;
    return inputs;
}

// Mean light of a channel in front of the slab: 1 - Product(1 - s c) is screen's.
double screened_front(const ShadedSplats& shaded, int channel) {
    constexpr int places = 800;
    double sum = 0.0;
    for (int place = 0; place < places; ++place) {
        const double px = (slab_half - 0.5) * (2.0 * double(test::uniform(place, 50)) - 1.0);
        const double pz = (slab_half - 0.5) * (2.0 * double(test::uniform(place, 51)) - 1.0);
        double dark = 1.0;
        for (std::size_t i = 0; i < shaded.position.size(); ++i) {
            const double dx = double(shaded.position[i].x) - px, dz = double(shaded.position[i].z) - pz;
            const double t = std::sqrt(dx * dx + dz * dz) / double(shaded.radius[i]);
            if (t < 1.0) dark *= 1.0 - double(shaded.alpha[i]) * (1.0 - t) * double(shaded.color[i][channel]);
        }
        sum += 1.0 - dark;
    }
    return sum / places;
}

TEST(PictureMatch, ScreenShowsThePicturesLight) {
    const SplatSet set = colored_slab();
    const ShadedSplats shaded = apply_look(set, picture_look(), picture_inputs(ColumnLaw::screen));
    const ShadedSplats covered =
        apply_look(set, picture_look(VerticalAlpha::Match::coverage), picture_inputs(ColumnLaw::screen));
    for (int c = 0; c < 3; ++c) {
        const double wanted = double(slab_alpha) * double(slab_color[c]);
        EXPECT_NEAR(screened_front(shaded, c), wanted, 0.015 * wanted) << c;
    }
    EXPECT_GT(screened_front(covered, 1), 1.06 * double(slab_alpha * slab_color[1]))
        << "as coverage still does";
}

TEST(PictureMatch, TakesTheColorAndAlphaOfTheLook) {
    Look look = picture_look();
    look.alpha.power = 2.0f;
    look.grade.gain = 0.5f;
    const ShadedSplats shaded = apply_look(colored_slab(), look, picture_inputs(ColumnLaw::screen));
    EXPECT_NEAR(screened_front(shaded, 0), 0.49 * 0.45, 0.02 * 0.49 * 0.45);
}

// Sums of alpha radius^2 over squares of the slab, of a seventh of its width: no whole number of cells.
std::vector<double> light_of_squares(const ShadedSplats& shaded) {
    std::vector<double> light(49);
    for (std::size_t i = 0; i < shaded.position.size(); ++i) {
        const auto along = [](float x) { return std::clamp(int((double(x) / slab_half + 1.0) * 3.5), 0, 6); };
        light[std::size_t(along(shaded.position[i].z) * 7 + along(shaded.position[i].x))] +=
            double(shaded.alpha[i]) * double(shaded.radius[i]) * double(shaded.radius[i]);
    }
    return light;
}

// Standard deviation over the mean, without the outermost squares.
double spread(const std::vector<double>& light) {
    double sum = 0.0, squares = 0.0, count = 0.0;
    for (std::size_t i = 0; i < light.size(); ++i) {
        if (i % 7 == 0 || i % 7 == 6 || i < 7 || i >= 42) continue;
        sum += light[i], squares += light[i] * light[i], count += 1.0;
    }
    const double mean = sum / count;
    return std::sqrt(squares / count - mean * mean) / mean;
}

TEST(PictureMatch, ThinningLeavesEveryCellItsLight) {
    const SplatSet set = colored_slab(0.5 * slab_spacing);  // squares of 8 x 8 cells
    Look look = picture_look(), covered = picture_look(VerticalAlpha::Match::coverage);
    look.density = covered.density = 0.1f;
    const LookInputs inputs = picture_inputs(ColumnLaw::transmittance);
    const double even = spread(light_of_squares(apply_look(set, look, inputs)));
    const double grainy = spread(light_of_squares(apply_look(set, covered, inputs)));
    EXPECT_GT(grainy, 0.02);
    EXPECT_LT(even, 0.6 * grainy);
    double total = 0.0, whole = 0.0;
    for (const double light : light_of_squares(apply_look(set, look, inputs))) total += light;
    covered.density = 1.0f;
    for (const double light : light_of_squares(apply_look(set, covered, inputs))) whole += light;
    EXPECT_NEAR(total, whole, 0.02 * whole);
}

TEST(PictureMatch, NothingChangesWhereEverythingIsKept) {
    const SplatSet set = colored_slab();
    const LookInputs inputs = picture_inputs(ColumnLaw::transmittance);
    const ShadedSplats picture = apply_look(set, picture_look(), inputs);
    const ShadedSplats coverage = apply_look(set, picture_look(VerticalAlpha::Match::coverage), inputs);
    EXPECT_EQ(picture.alpha, coverage.alpha);
    EXPECT_EQ(picture.color, coverage.color);
}

TEST(PictureMatch, TheSameBitsOnAnyThreadsAndInPlace) {
    SplatSet set = colored_slab();
    Look look = picture_look();
    look.density = 0.3f;
    look.noise = {{1.3f, 4, 2.1f, 0.5f, 3, 0.6f, 0.4f, 0.1f, 0.5f, 0.2f}};
    const LookInputs inputs = picture_inputs(ColumnLaw::screen);
    set_thread_count(1);
    const ShadedSplats one = apply_look(set, look, inputs);
    set_thread_count(5);
    const ShadedSplats five = apply_look(set, look, inputs);
    const ShadedSplats in_place = apply_look_in_place(set, look, inputs);
    set_thread_count(0);
    EXPECT_EQ(one.alpha, five.alpha);
    EXPECT_EQ(one.color, five.color);
    EXPECT_EQ(one.alpha, in_place.alpha);
    EXPECT_EQ(one.id, in_place.id);
}

}  // namespace
}  // namespace astrosplat
