#include "bodies/galaxy_fit.h"

#include "support/painted_picture.h"
#include "support/test.h"

namespace astrosplat {
namespace {

double degrees_between(double a_deg, double b_deg) {
    const double turns = (a_deg - b_deg) / 180.0;
    return 180.0 * std::fabs(turns - std::round(turns));
}

GalaxyFit fit_of(const painted::Tilted& t) {
    return fit_galaxies(painted::tilted_galaxy(240, 150, t), Galaxies::one).front();
}

TEST(GalaxyFit, FindsTheTiltOfPaintedGalaxies) {
    std::vector<double> errors;
    for (const double inclination : {0.0, 40.0, 58.0, 72.0, 84.0, 88.0}) {
        const double angle = 20.0 + 1.7 * inclination;
        const GalaxyFit fit = fit_of({inclination, angle});
        const double error = std::fabs(fit.plane.inclination_deg - inclination);
        EXPECT_TRUE(error <= 12.0 || fit.inclination_differs_deg > 10.0)
            << inclination << " found as " << fit.plane.inclination_deg;
        errors.push_back(error);
        if (inclination < 45.0) continue;
        EXPECT_LT(degrees_between(fit.plane.angle * 180.0 / 3.14159265358979, angle), 8.0) << inclination;
        EXPECT_LT(fit.misfit, 0.12) << inclination;
    }
    std::ranges::sort(errors);
    EXPECT_LE(errors[errors.size() / 2], 4.0);
}

TEST(GalaxyFit, FindsTheCentre) {
    const GalaxyFit fit = fit_of({60.0, 30.0});
    EXPECT_NEAR(fit.plane.x, 0.5, 0.01);
    EXPECT_NEAR(fit.plane.y, 0.3125, 0.01);
}

// Dust before the bulge dims the near side.
TEST(GalaxyFit, FindsTheNearSide) {
    for (const double angle : {20.0, 160.0}) {
        for (const bool above : {true, false}) {
            const GalaxyFit fit = fit_of({77.0, angle, above, 4.0, 2.0});
            const bool turned = std::cos(fit.plane.angle - angle * 3.14159265358979 / 180.0) < 0.0;
            EXPECT_EQ((fit.plane.near_side > 0) != turned, above) << angle;
            EXPECT_GT(fit.near_sure, 0.15) << angle;
        }
    }
}

TEST(GalaxyFit, PartsTheBulgeFromTheDisk) {
    EXPECT_LT(fit_of({80.0, 20.0, true, 0.0, 0.0}).bulge, 0.08);
    EXPECT_GT(fit_of({80.0, 20.0, true, 8.0, 0.0}).bulge, 0.15);
}

TEST(GalaxyFit, OfNoLightIsNothing) {
    const GalaxyFit fit = fit_galaxies(make_image(64, 40, 3), Galaxies::one).front();
    EXPECT_TRUE(std::isfinite(fit.plane.inclination_deg) && std::isfinite(fit.misfit));
}

}  // namespace
}  // namespace astrosplat
