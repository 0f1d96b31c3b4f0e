// Looks in which all operators meet, for tests that compare two ways to apply them.
#pragma once

#include "unit/look/sets.h"

namespace astrosplat::test {

/// A set with a look, and what that needs besides.
struct LookCase {
    static constexpr std::int64_t splats = 70001;  // several chunks, the last one odd
    std::string name;
    SplatSet set = file_set(splats);
    Image map = make_image(3, 2, 3);
    Look look;
    LookInputs inputs;
};

/// Every operator at once.
inline void use_everything(LookCase& c) {
    for (std::size_t i = 0; i < c.map.pixels.size(); ++i) c.map.pixels[i] = uniform(std::int64_t(i), 70);
    for (std::int64_t i = 0; i < LookCase::splats; ++i) c.set.uv.push_back({uniform(i, 71), uniform(i, 72)});
    c.set.spacing = {0.1, 0.1, 0.1};
    c.inputs.axis = {0.3f, 0.8f, -0.2f};
    c.look.density = 0.8f;
    c.look.reach = 1.7f;
    c.look.thickness.map = "map.exr";
    c.look.thickness.stops.resize(3);
    c.look.thickness.stops[0] = {{0.2f, 0.4f, 0.1f}, 1.0f, {}};
    c.look.thickness.stops[1] = {{0.9f, 0.4f, 0.8f}, 0.6f, {}};
    c.look.thickness.stops[1].pdf.shape = DensityCurve::Shape::gaussian;
    c.look.thickness.stops[2].pdf.shape = DensityCurve::Shape::curve;
    c.look.thickness.stops[2].pdf.points = {{0.1f, 0.9f}, {0.5f, 0.2f}, {0.8f, 0.7f}};
    c.look.noise = {{1.3f, 4, 2.1f, 0.5f, 3, 0.6f, 0.4f, 0.1f, 0.5f, 0.2f},
                    {5.3f, 2, 2.0f, 0.7f, 8, 0.0f, 0.0f, 0.05f, 0.3f, 0.4f}};
    c.look.crop.resize(2);
    c.look.crop[0].size = {6.0f, 0.8f, 7.0f};
    c.look.crop[0].rotate = {3.0f, 20.0f, 4.0f};
    c.look.crop[0].soft = 0.4f;
    c.look.crop[1].shape = Crop::Shape::sphere;
    c.look.crop[1].keep = Crop::Keep::outside;
    c.look.alpha = {1.7f, 0.9f, true, 1.2f};
    c.look.vertical.shape = VerticalAlpha::Shape::exponential;
    c.look.vertical.reach = 0.9f;
    c.look.vertical.match = VerticalAlpha::Match::coverage;
    c.look.radius = {0.05f, 0.2f, 1.6f, 0.7f};
    c.look.grade = {1.3f, {1.0f, 0.8f, 0.9f}, 1.4f, 1.8f, 0.05f};
}

/// Polygons one within the other, a long stroke and two short ones, from near, from far and without an eye.
inline void use_outlines(Look& look) {
    const auto add = [&](const char* lines, float width, const glm::vec3& eye, Crop::Keep keep) -> Crop& {
        Crop crop;
        crop.shape = Crop::Shape::outline;
        crop.outline = lines;
        crop.width = width;
        crop.center = eye;
        crop.keep = keep;
        look.crop.push_back(crop);
        return look.crop.back();
    };
    add("M -2 -2 2 -1.7 0.3 2.5 M -0.2 -0.2 0.2 -0.2 0.1 0.3", 0.0f, {0.2f, 0.1f, 2.0f}, Crop::Keep::inside)
        .soft = 0.3f;
    Crop& strokes = add("M -0.1 0.4 0 0.1 0.2 -0.3 M 0.05 0.25 0.2 0.3 M -0.4 -0.4 -0.3 -0.3", 0.05f,
                        {1.0f, 4.0f, 3.0f}, Crop::Keep::outside);
    strokes.rotate = {-40.0f, 15.0f, 3.0f};
    strokes.soft = 0.2f;
    add("M -0.3 0.5 0.5 -0.4", 0.1f, {0.0f, 0.0f, 0.0f}, Crop::Keep::outside).parallel = true;
}

inline std::vector<LookCase> look_cases() {
    std::vector<LookCase> all(7);
    all[0].name = "everything";
    use_everything(all[0]);
    all[1].name = "defaults";
    all[2].name = "curve, s106, sum";
    all[2].set.spacing = {0.1, 0.2, 0.1};
    all[2].look.pdf.shape = DensityCurve::Shape::curve;
    all[2].look.pdf.points = {{0.1f, 0.9f}, {0.5f, 0.2f}, {0.8f, 0.7f}};
    all[2].look.vertical.shape = VerticalAlpha::Shape::s106;
    all[2].look.vertical.match = VerticalAlpha::Match::sum;
    all[4].name = "everything, and splats that absorb";
    use_everything(all[4]);
    all[4].set.absorbs = true;
    for (std::size_t i = 0; i < std::size_t(LookCase::splats); i += 3)
        all[4].set.color[i] = {-0.8f, -1.0f, -1.35f};
    all[3].name = "one key, culling noise";
    all[3].look.thickness.stops = {{glm::vec3(1.0f), 0.7f, {}}};
    all[3].look.thickness.stops[0].pdf.shape = DensityCurve::Shape::smooth;
    all[3].look.noise = {{2.0f, 3, 2.0f, 0.5f, 1, 0.7f, 0.0f, 0.0f, 0.0f, 0.0f}};
    all[5].name = "picture under screen";
    use_everything(all[5]);
    all[5].set.absorbs = true;
    all[5].look.thickness = {};
    all[5].set.uv.clear();  // and with it the cells of the picture
    all[5].look.vertical.match = VerticalAlpha::Match::picture;
    all[5].inputs.column = ColumnLaw::screen;
    all[6].name = "everything, and outlines";
    use_everything(all[6]);
    use_outlines(all[6].look);
    return all;
}

}  // namespace astrosplat::test
