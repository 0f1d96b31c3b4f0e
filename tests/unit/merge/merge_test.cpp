// Merged splats: trees, and clouds for a preview.
#include "merge/cut.h"
#include "merge/tree.h"
#include "render/footprint.h"
#include "render/lod.h"
#include "render/render.h"
#include "splats/splat_set.h"
#include "support/all_values.h"
#include "support/splats.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// Sets with the splats of a look that changes nothing, and cuts of them.

struct Cloud {
    std::shared_ptr<SplatSet> set = std::make_shared<SplatSet>();
    ShadedSplats splats;

    void add(const glm::vec3& position, const glm::vec3& color, float alpha, float radius, std::uint64_t id) {
        add_splat(*set, position, color, alpha);
        set->id.back() = id;
        splats.position.push_back(position);
        splats.color.push_back(color);
        splats.alpha.push_back(alpha);
        splats.radius.push_back(radius);
        splats.id.push_back(id);
    }
    void add(const glm::vec3& position, const glm::vec3& color, float alpha, float radius) {
        add(position, color, alpha, radius, std::uint64_t(set->size()));
    }
    MergedSplats merged(float weight = 1.0f) const {
        const auto tree = std::make_shared<const MergeTree>(build_merge_tree(*set));
        return merge_splats({set, tree, weight}, splats);
    }
};

/// Of one layer alone.
ShadedSplats cut_of(const MergedSplats& merged, const MergeSettings& merging,
                    const LayerProjection& projection, const CutSettings& settings) {
    const CutLayer cut{&merged, &merging, projection};
    return std::move(cut_splats(std::span(&cut, 1), settings)[0]);
}

// Trees, sums and cuts in closed form: light, second moments and transmittance stay, whatever is merged.

constexpr int width = 256, height = 256;

float uniform(std::uint32_t i, std::uint32_t which) {
    return shared::as_uniform(shared::as_hash(7u, i, 0u, which));
}

/// In [-1, 1]^3 scaled by `extent`.
Cloud random_cloud(std::uint32_t count, const glm::vec3& extent, float radius, float alpha) {
    Cloud cloud;
    for (std::uint32_t i = 0; i < count; ++i)
        cloud.add(extent * (2.0f * glm::vec3(uniform(i, 0), uniform(i, 1), uniform(i, 2)) - 1.0f),
                  {uniform(i, 3), 0.5f, uniform(i, 4) * uniform(i, 4)}, alpha * (0.5f + uniform(i, 5)),
                  radius * (0.5f + uniform(i, 6)));
    return cloud;
}

/// Looks along -z at all of [-1, 1]^3.
Camera camera(double half_height = 1.5) {
    CameraParams params;
    params.projection = Projection::orthographic;
    params.position = glm::dvec3(0.0, 0.0, 10.0);
    params.height = 2.0 * half_height;
    return make_camera(params, width, height, {});
}

LayerRender render_as(Blend blend) {
    LayerRender render;
    render.blend = blend;
    return render;
}

ShadedSplats cut_of(const MergedSplats& merged, std::int64_t budget, const LayerRender& render = {},
                    const Camera& seen_by = camera(), float least_px = 0.0f) {
    RenderLayer layer;
    layer.render = render;
    RenderSettings frame;
    frame.width = width;
    frame.height = height;
    return cut_of(merged, MergeSettings(render), make_projection(layer, 0, seen_by, frame),
                  {budget, least_px, width, height});
}

Image picture_of(const ShadedSplats& splats, const LayerRender& as, const Camera& seen_by = camera()) {
    RenderLayer layer;
    layer.splats = &splats;
    layer.render = as;
    RenderSettings settings;
    settings.width = width;
    settings.height = height;
    return render(std::span(&layer, 1), seen_by, nullptr, settings).beauty;
}

glm::dvec3 light_of(const ShadedSplats& splats) {
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < splats.alpha.size(); ++i)
        sum += double(splats.alpha[i]) * double(splats.radius[i]) * double(splats.radius[i]) *
               glm::dvec3(splats.color[i]);
    return sum;
}

TEST(Merge, ATreeHasEveryRowOnceAndChildrenOfBoth) {
    const Cloud cloud = random_cloud(5000, {1.0f, 0.1f, 1.0f}, 0.01f, 0.5f);
    const MergeTree tree = build_merge_tree(*cloud.set);
    std::vector<std::int64_t> rows(tree.rows.begin(), tree.rows.end());
    std::sort(rows.begin(), rows.end());
    for (std::int64_t i = 0; i < 5000; ++i) ASSERT_EQ(rows[i], i);
    ASSERT_EQ(tree.root_count(), 1);
    EXPECT_EQ(tree.levels.back(), std::int64_t(tree.nodes.size()));
    for (const MergeNode& node : tree.nodes) {
        if (node.is_leaf()) {
            EXPECT_LE(node.end - node.first, MergeTree::leaf_rows);
            continue;
        }
        EXPECT_EQ(tree.nodes[node.children].first, node.first);
        EXPECT_EQ(tree.nodes[node.children].end, tree.nodes[node.children + 1].first);
        EXPECT_EQ(tree.nodes[node.children + 1].end, node.end);
    }
}

TEST(Merge, SplatsAtOnePlaceAreALeaf) {
    Cloud cloud;
    for (int i = 0; i < 100; ++i) cloud.add({1.0f, 2.0f, 3.0f}, glm::vec3(0.5f), 0.1f, 0.5f);
    EXPECT_EQ(build_merge_tree(*cloud.set).nodes.size(), 1u);
    EXPECT_TRUE(build_merge_tree(SplatSet()).nodes.empty());
}

TEST(Merge, BuildingCanBeCancelled) {
    const std::atomic<bool> cancelled{true};
    const Cloud cloud = random_cloud(1000, glm::vec3(1.0f), 0.1f, 0.5f);
    EXPECT_THROW(build_merge_tree(*cloud.set, Progress{{}, &cancelled}), Cancelled);
    const auto tree = std::make_shared<const MergeTree>(build_merge_tree(*cloud.set));
    EXPECT_THROW(merge_splats({cloud.set, tree, 1.0f}, cloud.splats, Progress{{}, &cancelled}), Cancelled);
}

TEST(Merge, TheRootHasLightCentreAndSecondMomentsOfAll) {
    const Cloud cloud = random_cloud(3000, {1.0f, 0.3f, 0.6f}, 0.02f, 0.5f);
    double cover = 0.0, own = 0.0;
    glm::dvec3 centre(0.0), spread(0.0), skew(0.0);
    const auto each = [&](const auto& visit) {
        for (std::size_t i = 0; i < 3000; ++i) {
            const double r = cloud.splats.radius[i], c = double(cloud.splats.alpha[i]) * r * r;
            visit(c, r, glm::dvec3(cloud.splats.position[i]));
        }
    };
    each([&](double c, double r, const glm::dvec3& p) { cover += c, own += c * r * r, centre += c * p; });
    centre /= cover;
    each([&](double c, double, const glm::dvec3& p) {
        const glm::dvec3 d = p - centre;
        spread += c * d * d;
        skew += c * glm::dvec3(d.y * d.z, d.z * d.x, d.x * d.y);
    });
    const NodeSums root = cloud.merged().sums[0];
    EXPECT_NEAR(root.cover, cover, 1e-5 * cover);
    EXPECT_NEAR(root.own, own / cover, 1e-5 * own / cover);
    for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(root.light[k], light_of(cloud.splats)[k], 1e-5 * root.light[k]);
        EXPECT_NEAR(root.centre[k], centre[k], 1e-5);
        EXPECT_NEAR(root.spread[k], spread[k] / cover, 1e-5);
        EXPECT_NEAR(root.skew[k], skew[k] / cover, 1e-5);
    }
}

TEST(Merge, TheLightOfEveryCutIsThatOfTheWhole) {
    const Cloud cloud = random_cloud(20000, {1.0f, 0.2f, 1.0f}, 0.01f, 0.5f);
    const MergedSplats merged = cloud.merged();
    const glm::dvec3 whole = light_of(cloud.splats);
    for (const std::int64_t budget : {1, 10, 300, 4000, 20000}) {
        const ShadedSplats cut = cut_of(merged, budget, render_as(Blend::add));
        EXPECT_LE(cut.size(), budget);
        EXPECT_GE(double(cut.size()), 0.9 * double(budget));
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(light_of(cut)[k] / whole[k], 1.0, 1e-5) << budget;
    }
}

TEST(Merge, ACutThatHasRoomForAllIsAll) {
    const Cloud cloud = random_cloud(3000, glm::vec3(1.0f), 0.02f, 0.5f);
    const ShadedSplats cut = cut_of(cloud.merged(), 3000);
    ASSERT_EQ(cut.size(), 3000);
    std::vector<float> wanted(cloud.splats.radius.begin(), cloud.splats.radius.end()),
        found(cut.radius.begin(), cut.radius.end());
    std::sort(wanted.begin(), wanted.end());
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, wanted);
}

TEST(Merge, NothingIsDividedThatLooksSmallEnough) {
    const Cloud cloud = random_cloud(20000, glm::vec3(0.05f), 0.001f, 0.5f);
    const std::int64_t fine = cut_of(cloud.merged(), 20000, {}, camera(), 1.5f).size();
    const std::int64_t coarse = cut_of(cloud.merged(), 20000, {}, camera(), 6.0f).size();
    EXPECT_LT(fine, 10000);  // the cloud is 9 px wide
    EXPECT_LT(coarse, fine / 4);
    EXPECT_GT(coarse, 1);
}

/// 4096 splats evenly spaced along 64 px.
Cloud thread(const glm::vec3& direction) {
    constexpr float length = 64.0f * 3.0f / float(height);
    Cloud cloud;
    for (int i = 0; i < 4096; ++i)
        cloud.add(direction * length * ((float(i) + 0.5f) / 4096.0f - 0.5f), glm::vec3(1.0f), 0.1f, 1e-4f);
    return cloud;
}

TEST(Merge, AThreadIsHalvedUntilItsPartsLookSmallEnough) {
    for (const glm::vec3 direction : {glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)}) {
        const MergedSplats merged = thread(direction).merged();
        const auto count = [&](float least_px) {
            return cut_of(merged, 4096, {}, camera(), least_px).size();
        };
        EXPECT_EQ(count(66.0f), 1);
        EXPECT_EQ(count(62.0f), 2) << "its length counts";
        EXPECT_EQ(count(33.0f), 2);
        EXPECT_EQ(count(5.0f), 16);
        EXPECT_EQ(count(3.0f), 32);
    }
    EXPECT_EQ(cut_of(thread({0, 0, 1}).merged(), 4096, {}, camera(), 5.0f).size(), 1) << "seen along it";
}

TEST(Merge, WhereAllThatLooksLargeIsDividedMoreRoomChangesNothing) {
    const MergedSplats merged = random_cloud(20000, glm::vec3(0.1f), 0.001f, 0.5f).merged();
    const std::int64_t enough = cut_of(merged, 20000, {}, camera(), 3.0f).size();
    EXPECT_GT(enough, 100);
    EXPECT_LT(enough, 5000);
    for (const std::int64_t more : {enough + enough / 10, enough + enough / 2, 4 * enough})
        EXPECT_EQ(cut_of(merged, more, {}, camera(), 3.0f).size(), enough) << more;
}

TEST(Merge, WhatTheFrameDoesNotShowTakesNoSplats) {
    const Cloud cloud = random_cloud(20000, glm::vec3(1.0f), 0.001f, 0.5f);
    const ShadedSplats cut = cut_of(cloud.merged(), 2000, {}, camera(0.1));
    EXPECT_GT(cut.size(), 100);
    for (const glm::vec3& p : cut.position) {
        EXPECT_LT(std::fabs(p.x), 0.3f);
        EXPECT_LT(std::fabs(p.y), 0.3f);
    }
}

/// Mean over the middle of a picture, where a cloud's edges do not reach.
double mean_of_middle(const Image& picture, int channel) {
    double sum = 0.0;
    int count = 0;
    for (int y = 3 * height / 8; y < 5 * height / 8; ++y)
        for (int x = 3 * width / 8; x < 5 * width / 8; ++x, ++count) sum += picture.at(x, y)[channel];
    return sum / count;
}

TEST(Merge, AColumnLetsThroughWhatItDidUnderEveryBlend) {
    for (const float alpha : {0.05f, 0.3f, 0.6f}) {
        const Cloud cloud = random_cloud(12000, glm::vec3(1.0f), 0.03f, alpha);
        const MergedSplats merged = cloud.merged();
        for (const Blend blend : {Blend::over, Blend::add, Blend::screen, Blend::hybrid, Blend::absorb}) {
            SCOPED_TRACE(testing::Message() << "alpha " << alpha << ", blend " << int(blend));
            const Image whole = picture_of(cloud.splats, render_as(blend));
            const Image cut = picture_of(cut_of(merged, 1500, render_as(blend)), render_as(blend));
            for (int k = 0; k < 4; ++k) {
                const double wanted = mean_of_middle(whole, k);
                EXPECT_NEAR(mean_of_middle(cut, k), wanted, 0.03 * wanted) << k;
            }
        }
    }
}

TEST(Merge, OneSplatIsItselfUnderEveryBlend) {
    for (const Blend blend : {Blend::over, Blend::add, Blend::screen, Blend::lighten, Blend::hybrid})
        for (const float alpha : {0.01f, 0.5f, 0.97f}) {
            Cloud cloud;
            cloud.add({0.2f, 0.1f, 0.0f}, {0.9f, 0.4f, 0.1f}, alpha, 0.25f);
            const NodeSplat splat =
                splat_of(MergeSettings(render_as(blend)), cloud.merged().sums[0], {0.0f, 0.0f}, 0.3f);
            EXPECT_NEAR(splat.radius, 0.25, 1e-6);
            EXPECT_NEAR(splat.alpha, alpha, 2e-4);
            EXPECT_NEAR(splat.color.x * splat.alpha, 0.9f * alpha, 3e-4);
            EXPECT_NEAR(splat.color.z * splat.alpha, 0.1f * alpha, 3e-4);
        }
}

TEST(Merge, StarsCloseByAreThePointsOfTheFinalFrame) {
    Cloud cloud;
    for (const float x : {-0.1f, 0.1f})
        cloud.add({x, 0.0f, 0.0f}, {1.0f, 0.8f, 0.6f}, 0.3f, 0.05f, std::uint64_t{star_band} << 48);
    CameraParams params;
    params.position = {0.0, 0.0, 2.0};
    params.fov = 10.0;
    const Camera near_by = make_camera(params, width, height, {});
    LayerRender as_splat, as_point;
    as_point.lod.star_distance = 8.0f;
    const Image preview = picture_of(cut_of(cloud.merged(), 10, as_point, near_by), as_splat, near_by),
                final = picture_of(cloud.splats, as_point, near_by),
                splat = picture_of(cloud.splats, as_splat, near_by);
    const float brightest = *std::ranges::max_element(final.pixels);
    EXPECT_GT(brightest, 2.0f * *std::ranges::max_element(splat.pixels));
    for (std::size_t i = 0; i < final.pixels.size(); ++i)
        ASSERT_NEAR(preview.pixels[i], final.pixels[i], 1e-3f * brightest);
}

TEST(Merge, OpacityOfTheLayerIsInTheSplats) {
    const Cloud cloud = random_cloud(500, glm::vec3(0.1f), 0.01f, 0.1f);
    LayerRender render;
    render.opacity = 0.5f;
    const MergedSplats merged = cloud.merged();
    EXPECT_NEAR(cut_of(merged, 1, render).alpha[0] / cut_of(merged, 1).alpha[0], 0.5, 0.02);
    EXPECT_EQ(cut_of(merged, 500, render).alpha[0], 0.5f * cut_of(merged, 500).alpha[0]);
}

TEST(Merge, TheDepthOfASplatAndItsAlphaAreInverse) {
    for (const auto shape : test::all_values<Falloff::Shape>) {
        Falloff falloff;
        falloff.shape = shape;
        const DepthTable table(falloff);
        for (const double alpha : {1e-6, 1e-3, 0.1, 0.4, 0.8, 0.99})
            EXPECT_NEAR(table.alpha(table.depth(alpha)) / alpha, 1.0, 1e-3);
        EXPECT_NEAR(table.depth(1e-6), 1e-6 * falloff_integral(falloff), 1e-10);
        EXPECT_EQ(table.alpha(table.depth(1.0)), 1.0);
    }
    Falloff disc;
    disc.shape = Falloff::Shape::constant;
    EXPECT_NEAR(DepthTable(disc).depth(0.5), 3.14159265 * std::log(2.0), 1e-3);
}

TEST(Merge, AThreadOfSplatsIsARowOfMergedOnes) {
    Cloud cloud;
    for (std::uint32_t i = 0; i < 4000; ++i) {
        const float along = 2.0f * uniform(i, 0) - 1.0f;
        cloud.add({along, 0.5f * along, 0.0f}, glm::vec3(0.5f), 0.2f, 0.004f);
    }
    const ShadedSplats cut = cut_of(cloud.merged(), 64);
    EXPECT_GE(cut.size(), 48);
    for (std::size_t i = 0; i < cut.radius.size(); ++i) {
        EXPECT_NEAR(cut.position[i].y, 0.5f * cut.position[i].x, 1e-4);
        EXPECT_LT(cut.radius[i], 0.1f);  // a splat for every 0.035 of the length
    }
}

TEST(Merge, SplatsThatAbsorbAreNotMergedWithLight) {
    Cloud cloud = random_cloud(1000, glm::vec3(1.0f), 0.02f, 0.5f);
    for (std::size_t i = 0; i < 1000; i += 3)
        cloud.set->color[i] = cloud.splats.color[i] = {-0.5f, -1.0f, -2.0f};
    cloud.set->absorbs = true;
    for (const std::int64_t budget :
         {1, 2}) {  // each has a root of its own, even where one splat was asked for
        const ShadedSplats cut = cut_of(cloud.merged(), budget);
        ASSERT_EQ(cut.size(), 2);
        EXPECT_GT(cut.color[0].x, 0.0f);
        EXPECT_NEAR(cut.color[1].x, -0.5f, 1e-6);
        EXPECT_NEAR(cut.color[1].z, -2.0f, 1e-6);
    }
}

TEST(Merge, WhatTheLookDropsIsNotThere) {
    Cloud cloud = random_cloud(2000, glm::vec3(1.0f), 0.02f, 0.5f);
    Cloud kept;
    for (std::size_t i = 0; i < 2000; ++i)
        if (uniform(std::uint32_t(i), 9) < 0.4f) {
            kept.add(cloud.splats.position[i], cloud.splats.color[i], cloud.splats.alpha[i],
                     cloud.splats.radius[i]);
            kept.splats.id.back() = i;
        }
    cloud.splats = kept.splats;
    const MergedSplats merged = cloud.merged();
    EXPECT_NEAR(merged.sums[0].light.y / light_of(kept.splats).y, 1.0, 1e-5);
    EXPECT_EQ(cut_of(merged, 2000).size(), kept.set->size());
    cloud.splats = ShadedSplats();
    EXPECT_EQ(cut_of(cloud.merged(), 100).size(), 0);
}

// Haze whose splats are as wide as their cloud looks the same, however far it is divided.
TEST(Merge, WhatIsFineGetsTheSplatsAndNotTheHazeBesideIt) {
    const MergedSplats fine = random_cloud(20000, glm::vec3(1.0f), 0.02f, 0.2f).merged(),
                       haze = random_cloud(20000, glm::vec3(1.0f), 1.0f, 0.01f).merged();
    const MergeSettings settings{LayerRender()};
    RenderSettings frame;
    frame.width = width;
    frame.height = height;
    const LayerProjection seen = make_projection(RenderLayer(), 0, camera(), frame);
    const std::array<CutLayer, 2> layers = {CutLayer{&fine, &settings, seen}, {&haze, &settings, seen}};
    const std::vector<ShadedSplats> cut = cut_splats(layers, {2000, 1.5f, width, height});
    EXPECT_GT(cut[0].size(), 1500);
    EXPECT_GT(cut[1].size(), 1) << "it has a shape of its own";
    EXPECT_LT(cut[1].size(), 200);
}

TEST(Merge, ASampleStandsForTheWhole) {
    const Cloud cloud = random_cloud(64000, {1.0f, 0.2f, 1.0f}, 0.02f, 0.2f);
    const MergeTree tree = build_merge_tree(*cloud.set);
    const SplatSet taken = sample_tree(tree, *cloud.set, 4000);
    EXPECT_EQ(taken.size(), 4000);
    EXPECT_EQ(std::set(taken.id.begin(), taken.id.end()).size(), 4000u);
    Cloud sample;
    for (const std::uint64_t id : taken.id)
        sample.add(cloud.splats.position[id], cloud.splats.color[id], cloud.splats.alpha[id],
                   cloud.splats.radius[id]);
    const ShadedSplats cut = cut_of(sample.merged(16.0f), 4000, render_as(Blend::add));
    EXPECT_LT(cut.size(), 1000) << "no splat of a sample is shown by itself";
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(light_of(cut)[k] / light_of(cloud.splats)[k], 1.0, 0.03);
}

/// A few bright ones in a haze of the same place.
TEST(Merge, StarsOfPicturesStayPointsInAHaze) {
    Cloud cloud = random_cloud(40000, {1.0f, 1.0f, 0.1f}, 0.1f, 0.05f);
    constexpr int stars = 20;
    for (std::uint32_t i = 0; i < stars; ++i)
        cloud.add({1.6f * uniform(i, 8) - 0.8f, 1.6f * uniform(i, 9) - 0.8f, 0.0f}, glm::vec3(5.0f), 1.0f,
                  0.01f, star_band << band_bit | i);
    const ShadedSplats cut = cut_of(cloud.merged(), 2000, render_as(Blend::add));
    int points = 0;
    for (std::int64_t i = 0; i < cut.size(); ++i)
        points += cut.radius[i] <= 0.0101f && cut.color[i].x > 4.99f;
    EXPECT_EQ(points, stars);
}

/// Large splats among many small ones, as of bodies: by number they would hardly be met, and then stand for
/// many.
TEST(Merge, ASampleByLightHasTheLightOfLargeSplatsAndOfSmallOnes) {
    Cloud cloud = random_cloud(60000, {1.0f, 1.0f, 0.2f}, 0.01f, 0.5f);
    for (std::uint32_t i = 0; i < 10; ++i)
        cloud.add({2.0f * uniform(i, 8) - 1.0f, 2.0f * uniform(i, 9) - 1.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, 0.5f,
                  0.7f);
    cloud.set->alpha = cloud.splats.alpha;
    cloud.set->radius = cloud.splats.radius;
    const auto sums_of = [&](MergeSource source) {
        Cloud few;
        for (const std::uint64_t id : source.set->id)
            few.add(cloud.splats.position[id], cloud.splats.color[id], cloud.splats.alpha[id],
                    cloud.splats.radius[id], id);
        source.tree = std::make_shared<const MergeTree>(build_merge_tree(*source.set));
        return NodeSums(merge_splats(source, few.splats).sums[0]);
    };
    const NodeSums all = cloud.merged().sums[0];
    const MergeSource sample = sample_light(*cloud.set, 2000);
    EXPECT_LE(sample.set->size(), 2001);
    EXPECT_GT(sample.set->size(), 900);
    const NodeSums found = sums_of(sample);
    EXPECT_NEAR(found.cover / all.cover, 1.0, 0.03);
    EXPECT_NEAR(found.light.x / all.light.x, 1.0, 0.03);
    EXPECT_NEAR(found.squares / all.squares, 1.0, 0.05) << "each is as many as it stands for";
    const auto rows = std::make_shared<const SplatSet>(sample_rows(*cloud.set, 2000));
    const NodeSums by_number = sums_of({rows, nullptr, float(cloud.set->size()) / 2000.0f, nullptr});
    EXPECT_GT(std::fabs(by_number.cover / all.cover - 1.0f), 0.05f) << "what this is for";
}

/// Brighter, wider, fewer and of another colour, in one half more than in the other.
TEST(Merge, RelitCutsHaveTheLightOfTheOtherLook) {
    const Cloud cloud = random_cloud(64000, {1.0f, 1.0f, 0.2f}, 0.02f, 0.2f);
    const auto tree = std::make_shared<const MergeTree>(build_merge_tree(*cloud.set));
    const MergedSplats merged = merge_splats({cloud.set, tree, 1.0f}, cloud.splats);
    const auto under_another = [&](const SplatSet& set, float dimmer = 1.0f) {
        ShadedSplats splats;
        for (const std::uint64_t id : set.id) {
            const glm::vec3 p = cloud.splats.position[id];
            if (uniform(std::uint32_t(id), 11) < 0.4f) continue;
            splats.position.push_back(p);
            splats.color.push_back(cloud.splats.color[id] * glm::vec3(p.x < 0.0f ? 2.0f : 0.5f, 1.5f, 0.1f));
            splats.alpha.push_back(cloud.splats.alpha[id] * 0.7f * dimmer);
            splats.radius.push_back(cloud.splats.radius[id] * 1.5f);
            splats.id.push_back(id);
        }
        return splats;
    };
    const SplatSet sample = sample_tree(*tree, *cloud.set, 4000);
    const Relight relight(merged, sample, under_another(sample));
    EXPECT_TRUE(relight.is_true());
    EXPECT_NEAR(relight.kept(), 0.6, 0.03);
    const Relight dimmed(merged, sample, under_another(sample, 0.1f)),
        again(merged, sample, under_another(sample), &dimmed);
    for (std::int64_t first = 0; first + 50 < 64000; first += 997) {
        EXPECT_EQ(again.of(first, first + 50).light, relight.of(first, first + 50).light) << first;
        EXPECT_NE(again.of(first, first + 50).light, dimmed.of(first, first + 50).light) << first;
    }
    const ShadedSplats all = under_another(*cloud.set);
    const MergeSettings merging(render_as(Blend::add));
    RenderLayer layer;
    layer.render = merging.render;
    RenderSettings frame;
    frame.width = width;
    frame.height = height;
    const CutLayer seen{&merged, &merging, make_projection(layer, 0, camera(), frame), &relight};
    for (const std::int64_t budget : {500, 3000, 100000}) {
        const ShadedSplats cut = std::move(cut_splats(std::span(&seen, 1), {budget, 0.0f, width, height})[0]);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(light_of(cut)[k] / light_of(all)[k], 1.0, 0.03) << budget;
        const Image wanted = picture_of(all, merging.render), got = picture_of(cut, merging.render);
        double left[2] = {0.0, 0.0};
        for (std::int64_t y = 0; y < height; ++y)
            for (std::int64_t x = 0; x < width / 2; ++x)
                left[0] += double(wanted.at(x, y)[0]), left[1] += double(got.at(x, y)[0]);
        EXPECT_NEAR(left[1] / left[0], 1.0, 0.05) << budget;
    }
}

TEST(Merge, WhatAppearsCannotBeRelit) {
    Cloud cloud = random_cloud(64000, {1.0f, 1.0f, 0.2f}, 0.02f, 0.2f);
    const auto tree = std::make_shared<const MergeTree>(build_merge_tree(*cloud.set));
    const SplatSet sample = sample_tree(*tree, *cloud.set, 4000);
    ShadedSplats of_sample;
    for (const std::uint64_t id : sample.id)
        for_each_member([&](auto member) { (of_sample.*member).push_back((cloud.splats.*member)[id]); });
    const auto is_true = [&] {
        return Relight(merge_splats({cloud.set, tree, 1.0f}, cloud.splats), sample, of_sample).is_true();
    };
    EXPECT_TRUE(is_true());
    for (std::size_t i = 0; i < cloud.splats.alpha.size(); ++i)
        if (cloud.splats.position[i].x > 0.5f) cloud.splats.alpha[i] = 0.0f;
    EXPECT_FALSE(is_true()) << "a quarter was dark";
}

// What rounding left between two sums would make any light there many times as much. Dark: at the ends of
// blocks, in which sums are made.
TEST(Merge, WhereAllWasDarkNothingIsRelit) {
    Cloud cloud = random_cloud(64000, {1.0f, 1.0f, 0.2f}, 0.02f, 0.2f);
    const auto tree = std::make_shared<const MergeTree>(build_merge_tree(*cloud.set));
    const SplatSet sample = sample_tree(*tree, *cloud.set, 64000);
    ShadedSplats lit;
    for (const std::uint64_t id : sample.id)
        for_each_member([&](auto member) { (lit.*member).push_back((cloud.splats.*member)[id]); });
    const auto is_dark = [](std::int64_t row) { return (row + 16) % 1024 < 32; };
    for (std::int64_t row = 0; row < 64000; ++row)
        if (is_dark(row)) cloud.splats.alpha[std::size_t(tree->rows[row])] = 0.0f;
    const Relight relight(merge_splats({cloud.set, tree, 1.0f}, cloud.splats), sample, lit);
    for (std::int64_t end = 1024; end < 64000; end += 1024) {
        const Relight::Factors found = relight.of(end - 8, end + 8);
        EXPECT_EQ(found.cover, 1.0f) << end;
        EXPECT_EQ(found.light, glm::vec3(1.0f)) << end;
    }
}

TEST(Merge, TheSameBitsForAnyThreadCount) {
    const Cloud cloud = random_cloud(50000, {1.0f, 0.1f, 1.0f}, 0.01f, 0.5f);
    test::expect_same_bits([&] {
        const MergedSplats merged = cloud.merged();
        const ShadedSplats cut = cut_of(merged, 5000);
        return test::Bits() << merged.tree->rows << merged.sums << cut.position << cut.color << cut.alpha;
    });
}

// Structure close by (lod.noise) in a preview's splats: as bright as the children of the final frame are on
// average, and 1 where there are none.

/// Grey splats, each of which takes up a few blocks of the frame.
struct CloseBy {
    static constexpr int side = 256;  // px of the frame

    RenderLayer layer;
    Cloud cloud;
    Camera camera;
    RenderSettings frame;

    CloseBy() {
        layer.render.blend = Blend::add;
        layer.render.lod = {20.0f * 1080.0f / side, 64, 1.0f};
        layer.seed = 5;
        layer.splats = &cloud.splats;
        CameraParams params;
        params.projection = Projection::orthographic;
        params.position = glm::dvec3(0.0, 0.0, 10.0);
        params.height = 2.0;
        camera = make_camera(params, side, side, {});
        frame.width = side;
        frame.height = side;
    }
    void add(const glm::vec3& position, float radius, std::uint64_t id) {
        cloud.add(position, glm::vec3(0.5f), 0.05f, radius, id);
    }
    void fill(std::uint32_t count, float radius) {
        for (std::uint32_t i = 0; i < count; ++i) {
            const auto place = [&](std::uint32_t axis) {
                return 2.4f * shared::as_uniform(shared::as_hash(11u, i, 0u, axis)) - 1.2f;
            };
            add({place(0), place(1), place(2)}, radius, i);
        }
    }
    ShadedSplats cut(std::int64_t budget) const {
        return cut_of(cloud.merged(), MergeSettings(layer.render), make_projection(layer, 0, camera, frame),
                      {budget, 0.0f, side, side});
    }
    /// Light of blocks of 32 px.
    std::vector<double> blocks(const ShadedSplats& shown, bool children) const {
        RenderLayer drawn = layer;
        drawn.splats = &shown;
        if (!children) drawn.render.lod = {};
        const Image image = render(std::span(&drawn, 1), camera, nullptr, frame).beauty;
        constexpr int block = 32, blocks = side / block;
        std::vector<double> sums(blocks * blocks);
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x)
                sums[std::size_t(y / block * blocks + x / block)] += double(image.at(x, y)[0]);
        return sums;
    }
};

/// Root mean square of the relative difference.
double difference(const std::vector<double>& shown, const std::vector<double>& wanted) {
    double sum = 0.0;
    for (std::size_t i = 0; i < wanted.size(); ++i) sum += std::pow(shown[i] / wanted[i] - 1.0, 2);
    return std::sqrt(sum / double(wanted.size()));
}

double total(const std::vector<double>& blocks) {
    double sum = 0.0;
    for (const double block : blocks) sum += block;
    return sum;
}

TEST(CloudLight, SplatsAreBrightWhereTheirChildrenAre) {
    CloseBy scene;
    scene.fill(3000, 0.3f);
    const std::vector<double> final = scene.blocks(scene.cloud.splats, true);
    const double unlit = difference(scene.blocks(scene.cloud.splats, false), final);
    EXPECT_GT(unlit, 0.1) << "there is structure";
    for (const auto& [budget, share] :
         {std::pair{3000, 0.5}, {1000, 0.75}}) {  // of the splats; merged ones blur
        SCOPED_TRACE(budget);
        const std::vector<double> preview = scene.blocks(scene.cut(budget), false);
        EXPECT_LT(difference(preview, final), share * unlit);
        EXPECT_NEAR(total(preview) / total(final), 1.0, 0.03);
    }
}

TEST(CloudLight, IsOneWithoutChildren) {
    CloseBy scene;
    const auto light = [&](float radius) {
        const LayerProjection layer = make_projection(scene.layer, 0, scene.camera, scene.frame);
        CloudPlace place;
        place.in_camera = {0.3f, 0.1f, -10.0f};
        place.centre = {0.3f, 0.1f, 0.0f};
        place.spread = glm::vec3(0.4f * radius);
        place.radius = radius;
        place.alpha = 0.05f;
        place.color = glm::vec3(0.5f);
        return cloud_light(layer, place);
    };
    EXPECT_EQ(light(0.07f), 1.0f) << "18 px";
    EXPECT_NE(light(0.3f), 1.0f);
    EXPECT_NEAR(light(0.0782f), 1.0f, 0.01f) << "20.02 px: they fade in";
    scene.layer.render.lod.noise = 0.0f;
    EXPECT_EQ(light(0.3f), 1.0f);
    scene.layer.render.lod = {0.0f, 64, 1.0f};
    EXPECT_EQ(light(0.3f), 1.0f) << "nothing is divided";
}

TEST(CloudLight, StarsOfAPictureAreNoClouds) {
    CloseBy scene;
    scene.add({0.3f, 0.1f, 0.0f}, 0.3f, std::uint64_t{star_band} << 48);
    scene.add({-0.3f, 0.1f, 0.0f}, 0.3f, 1);
    const ShadedSplats cut = scene.cut(10);
    ASSERT_EQ(cut.size(), 2);
    const bool star_first = cut.position[0].x > 0.0f;
    EXPECT_EQ(cut.color[star_first ? 0 : 1].x, 0.5f);
    EXPECT_NE(cut.color[star_first ? 1 : 0].x, 0.5f);
}

// Splats in place of a lattice: as even as it was although its cells are alike and in line, and none of both
// sides of its middle.

struct Seen {
    double unevenness;  // standard deviation over mean of the light of its middle
    double cover;       // of what is drawn, over that of the splats
    std::size_t splats;
};

/// A block of 48 x 48 x `deep` splats through merged ones that stand for 64 each, from so many degrees off
/// its front. `weight`: of a sample.
Seen seen_through_splats(bool lattice, int deep = 48, double degrees = 0.0, float weight = 1.0f) {
    constexpr int splats_a_side = 48, side = 256, first = 96, end = 160;  // px
    Cloud cloud;
    const auto at = [](int i) { return (float(i) + 0.5f) / splats_a_side * 2.0f - 1.0f; };
    const int count = splats_a_side * splats_a_side * deep;
    for (int i = 0; i < count; ++i) {
        const int slice = i / splats_a_side / splats_a_side + (splats_a_side - deep) / 2;
        cloud.add({at(i % splats_a_side), at(i / splats_a_side % splats_a_side), at(slice)}, glm::vec3(0.5f),
                  0.01f, 2.0f / splats_a_side);
    }
    RenderLayer layer;
    layer.render.blend = Blend::add;
    CameraParams params;
    params.projection = Projection::orthographic;
    const double angle = real::radians(degrees);
    params.position = glm::dvec3(0.0, -10.0 * std::sin(angle), 10.0 * std::cos(angle));
    params.height = 3.0;
    const Camera camera = make_camera(params, side, side, {});
    RenderSettings frame;
    frame.width = frame.height = side;
    const ShadedSplats cut = cut_of(cloud.merged(weight), MergeSettings(layer.render, lattice),
                                    make_projection(layer, 0, camera, frame), {count / 64, 0.0f, side, side});
    layer.splats = &cut;
    const Image image = render(std::span(&layer, 1), camera, nullptr, frame).beauty;
    double sum = 0.0, squares = 0.0, cover = 0.0;
    const int rows = degrees > 0.0 ? (end - first) / 4 : (end - first) / 2;  // at an angle it is lower
    for (int y = side / 2 - rows; y < side / 2 + rows; ++y)
        for (int x = first; x < end; ++x) {
            const double light = double(image.at(x, y)[0]);
            sum += light;
            squares += light * light;
        }
    for (std::size_t i = 0; i < cut.radius.size(); ++i)
        cover += double(cut.alpha[i]) * double(cut.radius[i]) * double(cut.radius[i]);
    const double pixels = 2.0 * rows * (end - first), mean = sum / pixels;
    const double whole = count * 0.01 * (2.0 / splats_a_side) * (2.0 / splats_a_side);
    return {std::sqrt(squares / pixels - mean * mean) / mean, cover / whole, cut.radius.size()};
}

TEST(MergedLattice, HasNoStripes) {
    const double even = seen_through_splats(true).unevenness;
    EXPECT_LT(even, 0.14) << "waves 17 % high along either axis; the root mean square of both";
    EXPECT_GT(seen_through_splats(false).unevenness, 1.6 * even) << "as other sets' splats would look";
}

TEST(MergedLattice, SamplesHaveNoneThatCouldBeSeen) {
    for (const double degrees : {0.0, 60.0})
        EXPECT_LT(seen_through_splats(true, 48, degrees, 14.0f).unevenness,
                  0.3 * seen_through_splats(true, 48, degrees).unevenness)
            << degrees;
}

// Its cells look wider than high: each becomes several splats, which lie side by side and share its light.
TEST(MergedLattice, HasNoStripesAtAnAngleEither) {
    constexpr int deep = 8;
    for (const double degrees : {60.0, 72.0}) {
        const Seen seen = seen_through_splats(true, deep, degrees);
        EXPECT_LT(seen.unevenness, 0.16) << degrees;
        EXPECT_GT(seen_through_splats(false, deep, degrees).unevenness, 2.0 * seen.unevenness) << degrees;
        EXPECT_NEAR(seen.cover, 1.0, 1e-4) << degrees;
        EXPECT_LE(seen.splats, 48u * 48u * deep / 64u) << degrees;
        EXPECT_GT(seen.splats, 48u * 48u * deep / 192u) << degrees;
    }
}

TEST(MergedLattice, KeepsToItsBudgetFromEverySide) {
    for (const int deep : {2, 8, 48})
        for (double degrees = 0.0; degrees < 90.0; degrees += 5.0)
            EXPECT_LE(seen_through_splats(true, deep, degrees).splats, 48u * 48u * unsigned(deep) / 64u)
                << deep << " deep, from " << degrees;
}

/// Leaves of the tree over a disk that have splats from above its middle and from below it.
int mixed_leaves(double spacing) {
    constexpr std::uint32_t count = 20000;
    SplatSet set;
    set.spacing = glm::dvec3(spacing);
    const auto uniform = [](std::uint32_t i, std::uint32_t which) {
        return shared::as_uniform(shared::as_hash(7u, i, 0u, which));
    };
    for (std::uint32_t i = 0; i < count; ++i) {
        add_splat(set, {10.0f * uniform(i, 1), 0.72f * uniform(i, 2), 10.0f * uniform(i, 3)}, glm::vec3(0.5f),
                  0.5f);
    }
    const auto middle = float(bounds(set).center().y);
    const MergeTree tree = build_merge_tree(set);
    int mixed = 0;
    for (const MergeNode& node : tree.nodes) {
        if (!node.is_leaf()) continue;
        std::int64_t above = 0;
        for (std::int64_t r = node.first; r < node.end; ++r) above += set.position[tree.rows[r]].y > middle;
        mixed += above > 0 && above < node.end - node.first;
    }
    return mixed;
}

/// A merged splat of both would be all before the dust of a disk, or all behind it.
TEST(MergedLattice, IsHalvedInItsMiddle) {
    EXPECT_EQ(mixed_leaves(0.1), 0);
    EXPECT_GT(mixed_leaves(0.0), 100) << "as other sets are";
}

}  // namespace
}  // namespace astrosplat
