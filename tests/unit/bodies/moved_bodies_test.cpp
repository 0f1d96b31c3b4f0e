// What is seen while a body's model is dragged: some of its splats, moved, against those that the new model
// makes.
#include "bodies/moved_bodies.h"

#include "bodies/bodies.h"
#include "bodies_support.h"
#include "support/bits.h"
#include "support/painted_bodies.h"
#include "support/painted_picture.h"
#include "support/test.h"

namespace astrosplat {
namespace {

std::vector<TexturedMesh> meshes_of(const Image& picture) {
    std::vector<TexturedMesh> meshes;
    meshes.push_back(on_plane(picture));
    return meshes;
}

/// How far light lies from the picture's plane in the mean, and how far those towards its top lie before the
/// others.
struct Shape {
    double deep = 0.0, lean = 0.0;
};

Shape shape_of(const SplatSet& set) {
    double yy = 0.0, zz = 0.0, zy = 0.0, weights = 1e-30;
    for (std::size_t i = 0; i < set.id.size(); ++i) {
        if (set.color[i].x < 0.0f) continue;
        const double shine = double(set.color[i].x) * double(set.alpha[i]), radius = double(set.radius[i]),
                     weight = shine * radius * radius;
        const double deep = double(set.position[i].y), up = double(set.uv[i].y) - 0.5;
        weights += weight;
        zz += weight * std::fabs(deep);
        yy += weight * up * up;
        zy += weight * deep * up;
    }
    return {zz / weights, zy / yy};
}

struct Moved {
    Shape before, seen, wanted;
};

Moved moved(const Image& picture, const StructureParams& params, const StructureParams& now,
            std::int64_t texels = MovedBodies::usual_texels) {
    const SplatSet made = make_bodies(meshes_of(picture), params, 7, "a");
    const MovedBodies bodies(meshes_of(picture), params, 7, made, texels);
    return {shape_of(made), shape_of(bodies.under(now)),
            shape_of(make_bodies(meshes_of(picture), now, 7, "a"))};
}

constexpr double near = 0.1;  // of what is wanted

TEST(MovedBodies, AreAsTheyWereUnderTheirOwnModel) {
    const Image picture = painted::nebula(240, 150);
    const StructureParams params = of_kind(StructureKind::walls);
    const SplatSet made = make_bodies(meshes_of(picture), params, 7, "a");
    const MovedBodies bodies(meshes_of(picture), params, 7, made);
    EXPECT_TRUE(same_bits(bodies.under(params).position, made.position));
    StructureParams now = params;
    now.warp = 0.3;  // of another kind
    const SplatSet seen = bodies.under(now);
    for (std::size_t i = 0; i < made.id.size(); ++i)
        ASSERT_NEAR(seen.position[i].y, made.position[i].y, 1e-4f) << i;
}

TEST(MovedBodies, AreAsDeepAsTheNewModelHasThem) {
    using Change = std::function<void(StructureParams&)>;
    struct Case {
        StructureKind kind;
        const char* name;
        Change change;
    };
    const Case cases[] = {
        {StructureKind::sheet, "depth", [](StructureParams& p) { p.depth *= 0.4; }},
        {StructureKind::sheet, "height", [](StructureParams& p) { p.height = 0.6, p.depth = 0.02; }},
        {StructureKind::walls, "depth", [](StructureParams& p) { p.depth *= 0.4; }},
        {StructureKind::walls, "sheet", [](StructureParams& p) { p.kind = StructureKind::sheet; }},
        {StructureKind::sheet, "walls", [](StructureParams& p) { p.kind = StructureKind::walls; }},
    };
    const Image picture = painted::nebula(320, 200);
    for (const Case& c : cases) {
        StructureParams params = of_kind(c.kind), now = params;
        if (c.name == std::string("height")) params.depth = 0.02;
        c.change(now);
        ASSERT_TRUE(only_moves_bodies(params, now)) << c.name;
        const Moved m = moved(picture, params, now);
        EXPECT_GT(std::fabs(m.wanted.deep / m.before.deep - 1.0), 2.0 * near) << c.name << " changes nothing";
        EXPECT_NEAR(m.seen.deep / m.wanted.deep, 1.0, near) << c.name;
    }
}

TEST(MovedBodies, GalaxiesLeanAndSwell) {
    const Image picture = painted::tilted_galaxy(320, 200, {50.0, 0.0, true, 4.0, 0.0});
    StructureParams params = of_kind(StructureKind::disk);
    params.galaxy = {50.0, 0.0, glm::dvec2(0.5, 0.5), 90.0, {}};
    StructureParams now = params;
    now.galaxy.near_side = 270.0;
    Moved m = moved(picture, params, now, 40'000);
    EXPECT_LT(m.before.lean * m.wanted.lean, 0.0);
    EXPECT_NEAR(m.seen.lean / m.wanted.lean, 1.0, near) << "the other side is nearer";
    now = params;
    now.galaxy.inclination = 25.0;
    m = moved(picture, params, now);
    EXPECT_LT(m.wanted.lean, 0.7 * m.before.lean);
    EXPECT_NEAR(m.seen.lean / m.wanted.lean, 1.0, near);
    params.galaxy.inclination = now.galaxy.inclination = 0.0;
    now.height = 0.8;
    m = moved(picture, params, now, 40'000);
    EXPECT_GT(m.wanted.deep, 1.5 * m.before.deep);
    EXPECT_NEAR(m.seen.deep / m.wanted.deep, 1.0, near);
    now = params;
    now.warp = 0.3;
    m = moved(picture, params, now);
    EXPECT_GT(m.wanted.deep, 1.2 * m.before.deep);
    EXPECT_NEAR(m.seen.deep / m.wanted.deep, 1.0, near);
}

TEST(MovedBodies, WhatIsFoundInThePictureStaysAsItWasFound) {
    const Image picture = painted::tilted_galaxy(240, 150, {60.0, 25.0, true, 4.0, 0.0});
    StructureParams params = of_kind(StructureKind::disk);
    params.galaxy.inclination.reset();
    StructureParams now = params;
    now.flare = 2.0;
    const Moved m = moved(picture, params, now);
    EXPECT_NEAR(m.seen.lean / m.wanted.lean, 1.0, near);
    EXPECT_NEAR(m.seen.deep / m.wanted.deep, 1.0, near);
}

TEST(MovedBodies, AnAxisIsTilted) {
    const painted::Body body{painted::lobes(0.22), 90.0, 30.0};
    const Image picture = painted::times(painted::seen(body, 0.0), 2.0f);
    StructureParams params = of_kind(StructureKind::axis);
    params.tilt = 10.0;
    params.axis_angle = 90.0;
    StructureParams now = params;
    now.tilt = 45.0;
    const Moved m = moved(picture, params, now);
    EXPECT_GT(m.wanted.lean, m.before.lean);
    EXPECT_NEAR(m.seen.lean - m.before.lean, m.wanted.lean - m.before.lean,
                2.0 * near * (m.wanted.lean - m.before.lean));
}

TEST(MovedBodies, OpacityAndDustAreInTheirAlpha) {
    const Image picture = painted::galaxy(240, 150);
    const StructureParams params = of_kind(StructureKind::disk);
    StructureParams now = params;
    now.density = 0.4;
    now.dust = 0.4;
    const SplatSet made = make_bodies(meshes_of(picture), params, 7, "a"),
                   wanted = make_bodies(meshes_of(picture), now, 7, "a");
    const SplatSet seen = MovedBodies(meshes_of(picture), params, 7, made).under(now);
    const auto hides = [](const SplatSet& set, bool dust) {
        double sum = 0.0;
        for (std::size_t i = 0; i < set.id.size(); ++i)
            if ((set.color[i].x < 0.0f) == dust)
                sum += double(set.alpha[i]) * double(set.radius[i]) * double(set.radius[i]);
        return sum;
    };
    for (const bool dust : {false, true}) {
        EXPECT_LT(hides(wanted, dust), 0.8 * hides(made, dust)) << dust;
        EXPECT_NEAR(hides(seen, dust) / hides(wanted, dust), 1.0, near) << dust;
    }
    now.margin = 0.1;
    EXPECT_FALSE(only_moves_bodies(params, now));
    now = params;
    now.kind = StructureKind::columns;
    EXPECT_FALSE(only_moves_bodies(params, now));
}

}  // namespace
}  // namespace astrosplat
