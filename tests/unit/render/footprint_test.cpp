// Footprints and their falloffs.
#include "render/footprint.h"

#include "support/printing.h"
#include "support/test.h"
#include "unit/render/scenes.h"

namespace astrosplat {
namespace {

// Footprints: light at every size and place, flat cores, and the profile against a convolution done
// by brute force.

using test::all_shapes;

TEST(Falloff, IntegralsAreTheClosedForms) {
    const double pi = real::pi;
    EXPECT_NEAR(falloff_integral({Falloff::Shape::constant, 0.5f, 4.5f}), pi, 1e-6);
    EXPECT_NEAR(falloff_integral({Falloff::Shape::linear, 0.5f, 4.5f}), pi / 3.0, 1e-6);
    const double c = 0.375;
    EXPECT_NEAR(falloff_integral({Falloff::Shape::trapezoid, 0.375f, 4.5f}), pi / 3.0 * (1.0 + c + c * c),
                1e-6);
    for (const float k : {0.5f, 4.5f, 40.0f}) {
        const double e = std::exp(-double(k));
        EXPECT_NEAR(falloff_integral({Falloff::Shape::gaussian, 0.5f, k}),
                    pi * ((1.0 - e) / k - e) / (1.0 - e), 2e-6);
        EXPECT_NEAR(falloff_integral({Falloff::Shape::exponential, 0.5f, k}),
                    2.0 * pi * ((1.0 - e * (1.0 + k)) / (double(k) * k) - 0.5 * e) / (1.0 - e), 2e-6);
    }
}

TEST(Falloff, OfATrapezoidFallsFromItsCore) {
    EXPECT_EQ(falloff_value({Falloff::Shape::trapezoid, 0.5f, 4.5f}, 0.5), 1.0);
    EXPECT_NEAR(falloff_value({Falloff::Shape::trapezoid, 0.5f, 4.5f}, 0.75), 0.5, 1e-6);
}

/// Sum of the weights at all pixel centres.
double pixel_sum(const FootprintTable& table, float radius_px, float x_px, float y_px) {
    Footprint footprint;
    footprint_at(table, radius_px, x_px, y_px, footprint);
    const int reach = int(footprint.support_px) + 2;
    double sum = 0.0;
    for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x) {
            const float dx = float(x) + 0.5f - x_px, dy = float(y) + 0.5f - y_px;
            sum += footprint_weight(table, footprint, std::sqrt(dx * dx + dy * dy));
        }
    return sum;
}

struct FootprintCase {
    Falloff falloff;
    float pixel_filter_px;
    friend void PrintTo(const FootprintCase& given, std::ostream* out) {
        *out << testing::PrintToString(given.falloff.shape) << ", core " << given.falloff.core
             << ", sharpness " << given.falloff.sharpness << ", filter " << given.pixel_filter_px;
    }
};

class FootprintLight : public ::testing::TestWithParam<FootprintCase> {};

// The sum over all pixels is the falloff's integral times the squared radius, within 0.5 %,
// from 0.02 to 500 px.
TEST_P(FootprintLight, IsConservedAtEverySizeAndOffset) {
    const FootprintTable table = make_footprint_table(GetParam().falloff, GetParam().pixel_filter_px);
    const double integral = falloff_integral(GetParam().falloff);
    double worst = 0.0;
    for (const float radius :
         {0.02f, 0.05f, 0.1f, 0.2f, 0.3f, 0.45f, 0.6f,  0.8f,  1.0f,  1.13f, 1.3f,   1.5f,   1.8f,  2.05f,
          2.5f,  3.0f,  3.7f, 5.0f, 7.3f, 10.0f, 13.0f, 20.0f, 33.0f, 60.0f, 100.0f, 230.0f, 500.0f}) {
        const int offsets = radius < 40.0f ? 8 : 2;
        for (int i = 0; i < offsets; ++i)
            for (int j = 0; j < offsets; ++j) {
                const float x = float((i * 256 / offsets + 3) % 256) / 256.0f;
                const float y = float((j * 256 / offsets + 7) % 256) / 256.0f;
                const double error = pixel_sum(table, radius, x, y) / (integral * radius * radius) - 1.0;
                worst = std::max(worst, std::fabs(error));
                EXPECT_NEAR(error, 0.0, 0.005) << "radius " << radius << " at " << x << ", " << y;
            }
    }
    RecordProperty("worst", std::to_string(worst));
}

std::vector<FootprintCase> light_cases() {
    using Shape = Falloff::Shape;
    std::vector<FootprintCase> cases;
    for (std::size_t shape = 0; shape < names_of(Shape{}).size(); ++shape)
        cases.push_back({{Shape(shape), 0.5f, 4.5f}, 0.5f});
    cases.push_back({{Shape::trapezoid, 0.98f, 4.5f}, 0.5f});
    cases.push_back({{Shape::gaussian, 0.5f, 40.0f}, 0.5f});
    cases.push_back({{Shape::exponential, 0.5f, 30.0f}, 0.5f});
    for (const float filter : {0.3f, 2.0f})
        for (const Shape shape : {Shape::constant, Shape::gaussian})
            cases.push_back({{shape, 0.5f, 4.5f}, filter});
    return cases;
}

INSTANTIATE_TEST_SUITE_P(AllFalloffs, FootprintLight, ::testing::ValuesIn(light_cases()));

// From four filter deviations inside the edge of a constant disc, the weight is exactly 1.
TEST(Footprint, ConstantDiscIsExactlyOneInside) {
    for (const float filter : {0.3f, 0.5f, 1.0f, 2.0f}) {
        const FootprintTable table = make_footprint_table({Falloff::Shape::constant, 0.5f, 4.5f}, filter);
        for (const float radius : {2.01f, 2.06f, 2.5f, 3.0f, 8.1f, 9.0f, 47.3f, 500.0f, 3000.0f}) {
            Footprint footprint;
            footprint_at(table, radius, 0.25f, 0.5f, footprint);
            if (radius <= 4.0f * filter) continue;
            for (int i = 0; i <= 100; ++i) {
                const float d = (radius - 4.0f * filter) * float(i) * 0.0099f;
                ASSERT_EQ(footprint_weight(table, footprint, d), 1.0f) << filter << " " << radius << " " << d;
            }
        }
    }
}

/// The falloff convolved with the Gaussian filter at distance d, by summing over a fine grid of the filter.
double convolved(const Falloff& falloff, double radius, double sigma, double d) {
    constexpr int steps = 160;
    double sum = 0.0, mass = 0.0;
    for (int j = 0; j < steps; ++j)
        for (int i = 0; i < steps; ++i) {
            const double x = (i + 0.5 - steps / 2) * 8.0 / steps, y = (j + 0.5 - steps / 2) * 8.0 / steps;
            if (x * x + y * y > 16.0) continue;
            const double g = std::exp(-0.5 * (x * x + y * y));
            const double px = d + sigma * x, py = sigma * y;
            sum += g * falloff_value(falloff, std::sqrt(px * px + py * py) / radius);
            mass += g;
        }
    return sum / mass;
}

TEST(Footprint, WeightsEndAtZero) {
    for (const Falloff::Shape shape : all_shapes) {
        const FootprintTable table = make_footprint_table({shape, 0.5f, 4.5f}, 0.5f);
        for (const float radius : {0.3f, 2.0f, 7.0f, 40.0f}) {
            Footprint footprint;
            footprint_at(table, radius, 0.3f, 0.7f, footprint);
            EXPECT_NEAR(footprint_weight(table, footprint, 0.99999f * footprint.support_px), 0.0f, 4e-6f)
                << testing::PrintToString(shape) << ", radius " << radius;
        }
    }
}

TEST(Footprint, ProfileIsTheConvolution) {
    for (const Falloff::Shape shape : all_shapes) {
        const Falloff falloff{shape, 0.5f, 4.5f};
        const FootprintTable table = make_footprint_table(falloff, 0.5f);
        for (const float radius : {0.7f, 1.6f, 3.1f, 8.7f, 40.0f}) {
            Footprint footprint;
            footprint_at(table, radius, 0.25f, 0.25f,
                         footprint);  // where the ripple's first harmonics cancel
            for (int i = 0; i <= 40; ++i) {
                const float d = (radius + 2.0f) * float(i) / 40.0f;
                EXPECT_NEAR(footprint_weight(table, footprint, d), convolved(falloff, radius, 0.5, d), 0.004)
                    << "shape " << int(shape) << " radius " << radius << " d " << d;
            }
        }
    }
}

bool same_nodes(const FootprintNode& a, const FootprintNode& b) {
    return std::memcmp(a.cubic, b.cubic, sizeof a.cubic) == 0 &&
           std::memcmp(&a.moments, &b.moments, sizeof a.moments) == 0;
}

TEST(Footprint, NodesMadeWhenAskedForAreThoseOfTheWholeTable) {
    const Falloff falloff{Falloff::Shape::trapezoid, 0.5f, 4.5f};
    const FootprintTable whole = make_footprint_table(falloff, 0.5f);
    FootprintTable table = begin_footprint_table(falloff, 0.5f);
    EXPECT_EQ(table.end_made, 0u);
    // The second range lies apart from the first, the third within both, the last beyond the table.
    for (const auto& [least, largest] : std::vector<std::pair<float, float>>{
             {2.0f, 3.1f}, {9.0f, 9.0f}, {2.5f, 8.0f}, {0.001f, 0.001f}, {0.5f, 5000.0f}}) {
        make_footprint_nodes(table, least, largest);
        for (const float radius : {least, largest}) {
            const FootprintNodes made = footprint_nodes(table, radius),
                                 wanted = footprint_nodes(whole, radius);
            EXPECT_TRUE(same_nodes(*made.a, *wanted.a)) << radius;
            EXPECT_TRUE(same_nodes(*made.b, *wanted.b)) << radius;
        }
    }
    EXPECT_EQ(table.first_made, 0u);
    EXPECT_EQ(table.end_made, table.nodes.size());
    for (std::size_t i = 0; i < table.nodes.size(); ++i)
        EXPECT_TRUE(same_nodes(table.nodes[i], whole.nodes[i])) << i;
}

// The fold does not clamp s to 1 where opacities stay below 0.99.
void expect_cubics_in_unit_interval(const Falloff& falloff) {
    const FootprintTable table = make_footprint_table(falloff, 0.5f);
    float least = 1.0f, largest = 0.0f;
    for (const FootprintNode& node : table.nodes)
        for (int s = 0; s < FootprintNode::segments; ++s)
            for (int k = 0; k <= 32; ++k) {
                const float f = float(k) / 32.0f;
                const auto(&c)[4][FootprintNode::segments] = node.cubic;
                const float p = ((c[3][s] * f + c[2][s]) * f + c[1][s]) * f + c[0][s];
                least = std::min(least, p);
                largest = std::max(largest, p);
            }
    EXPECT_GT(least, -0.005f) << int(falloff.shape) << " " << falloff.sharpness;
    EXPECT_LT(largest, 1.005f) << int(falloff.shape) << " " << falloff.sharpness;
}

TEST(Footprint, CubicsHardlyLeaveTheUnitInterval) {
    for (const Falloff::Shape shape : all_shapes) expect_cubics_in_unit_interval({shape, 0.5f, 4.5f});
    for (const Falloff::Shape shape : {Falloff::Shape::gaussian, Falloff::Shape::exponential})
        for (const float sharpness : {0.5f, 12.0f, 100.0f})
            expect_cubics_in_unit_interval({shape, 0.5f, sharpness});
}

// Each falloff's traits against its formula: a shape that says too little of itself is noticed as soon as it
// has a name.

std::vector<Falloff> all_falloffs() {
    std::vector<Falloff> all;
    for (std::size_t shape = 0; shape < names_of(Falloff::Shape{}).size(); ++shape)
        for (const float core : {0.2f, 0.7f})
            for (const float sharpness : {0.5f, 4.5f, 30.0f})
                all.push_back({Falloff::Shape(shape), core, sharpness});
    return all;
}

std::string name(const Falloff& falloff) {
    return std::string(name_of(falloff.shape)) + ", core " + std::to_string(falloff.core) + ", sharpness " +
           std::to_string(falloff.sharpness);
}

TEST(Falloffs, BeginAtOneAndNeverRise) {
    for (const Falloff& falloff : all_falloffs()) {
        EXPECT_EQ(falloff_value(falloff, 0.0), 1.0) << name(falloff);
        EXPECT_EQ(falloff_value(falloff, 1.0), 0.0) << name(falloff);
        EXPECT_EQ(falloff_value(falloff, 2.0), 0.0) << name(falloff);
        for (int i = 1; i <= 100; ++i)
            EXPECT_LE(falloff_value(falloff, i * 0.01), falloff_value(falloff, (i - 1) * 0.01))
                << name(falloff);
        for (int i = 1; i < 1000; ++i)
            ASSERT_LE(falloff_value(falloff, i / 1000.0), falloff_value(falloff, (i - 1) / 1000.0) + 1e-7)
                << name(falloff) << " at " << i;
    }
}

TEST(Falloffs, AreFlatAsFarAsTheySay) {
    for (const Falloff& falloff : all_falloffs()) {
        const FalloffTraits traits = traits_of(falloff);
        EXPECT_EQ(traits.flat_core, traits.core > 0.0f) << name(falloff);
        double flat = 0.0;
        while (flat + 1e-3 < 1.0 && falloff_value(falloff, flat + 1e-3) == 1.0) flat += 1e-3;
        EXPECT_NEAR(flat, double(traits.core), 2e-3) << name(falloff);
    }
}

TEST(Falloffs, CarryNothingBeyondTheirReach) {
    for (const Falloff& falloff : all_falloffs()) {
        const double reach = traits_of(falloff).reach;
        EXPECT_LT(falloff_value(falloff, reach), 1.1e-5) << name(falloff);
        EXPECT_GT(falloff_value(falloff, 0.95 * reach), 1e-5) << name(falloff);
    }
}

/// Where slopes on both sides differ, there is a kink; where w only curves, they differ less on a finer look.
TEST(Falloffs, HaveTheKinksTheySay) {
    for (const Falloff& falloff : all_falloffs()) {
        const auto slope_jump = [&](double t, double h) {
            const double left = (falloff_value(falloff, t) - falloff_value(falloff, t - h)) / h;
            const double right = (falloff_value(falloff, t + h) - falloff_value(falloff, t)) / h;
            return std::fabs(right - left);
        };
        const std::vector<double> kinks = traits_of(falloff).kinks;
        for (double t = 0.01; t < 0.985; t += 0.005) {
            double jump = 0.0;  // the kink is at none of the places looked at, perhaps
            for (int k = -2; k <= 2; ++k) jump = std::max(jump, slope_jump(t + 0.00125 * k, 0.002));
            const bool is_kink = jump > 0.5 * slope_jump(t, 0.008) && jump > 0.05;
            const bool said =
                std::ranges::any_of(kinks, [&](double kink) { return std::fabs(kink - t) < 0.006; });
            EXPECT_TRUE(said || !is_kink) << name(falloff) << " at " << t;
        }
    }
}

/// Tables over the squared distance need a w that is smooth in it: no peak at the centre.
TEST(Falloffs, AreTabulatedAsTheirCentreIs) {
    for (const Falloff& falloff : all_falloffs()) {
        const double slope = (1.0 - falloff_value(falloff, 1e-3)) / 1e-3;
        EXPECT_TRUE(traits_of(falloff).linear_in_distance || slope <= 0.1) << name(falloff);
    }
}

}  // namespace
}  // namespace astrosplat
