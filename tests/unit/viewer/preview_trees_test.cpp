// Trees of previews: kept in the cache, and true to the light of the whole.
#include <tuple>

#include "core/file.h"
#include "core/log.h"
#include "gl/gl_fixture.h"
#include "merge/cut.h"
#include "render/footprint.h"
#include "support/preview_views.h"
#include "support/splats.h"
#include "support/test.h"
#include "viewer/loaded_layer.h"
#include "viewer/preview_splats.h"
#include "viewer/set_loader.h"

namespace astrosplat {
namespace {

// Trees in the cache: the same bits as built, for every set with the same positions; what is damaged is built
// again; how much they may take.

SplatSet cloud(std::uint32_t count, std::uint32_t seed = 1) {
    SplatSet set;
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto random = [&](std::uint32_t axis) {
            return shared::as_uniform(shared::as_hash(seed, i, 0u, axis));
        };
        add_splat(set, {random(0), random(1), random(2)}, {random(3), 0.5f, 0.5f}, 0.5f);
    }
    return set;
}

bool same(const MergeTree& a, const MergeTree& b) {
    const auto same_node = [](const MergeNode& m, const MergeNode& n) {
        return std::tie(m.first, m.end, m.children) == std::tie(n.first, n.end, n.children);
    };
    return a.rows == b.rows && a.levels == b.levels &&
           std::equal(a.nodes.begin(), a.nodes.end(), b.nodes.begin(), b.nodes.end(), same_node);
}

class KeptTreesTest : public testing::Test {
  protected:
    KeptTree begin(const SplatSet& set) const {
        KeptTree kept = read_or_build_tree(cache_, set);
        keep_tree(cache_, kept);
        return kept;
    }
    std::vector<fs::path> trees() const {
        std::vector<fs::path> found;
        for (const fs::path& file : entries_of(cache_.folder))
            if (file.extension() == ".tree") found.push_back(file);
        return found;
    }

    TempFolder folder_;
    SetCache cache_{folder_ / "cache"};
    Said said_;
};

TEST_F(KeptTreesTest, ASecondStartReadsTheTreeThatTheFirstOneBuilt) {
    const SplatSet set = cloud(100'000);
    const KeptTree first = begin(set), second = begin(set);
    EXPECT_FALSE(first.cached);
    ASSERT_TRUE(second.cached);
    EXPECT_EQ(trees(), std::vector{first.file});
    EXPECT_TRUE(same(*first.tree, build_merge_tree(set)));
    EXPECT_TRUE(same(*second.tree, *first.tree));
}

TEST_F(KeptTreesTest, ATreeIsOfPositionsAndOfWhatAbsorbs) {
    SplatSet set = cloud(3000);
    begin(set);
    set.color[5] = glm::vec3(0.25f);
    set.alpha[7] = 0.125f;
    EXPECT_TRUE(begin(set).cached) << "another look of the same positions";
    set.absorbs = true;
    set.color[5].x = -1.0f;
    EXPECT_FALSE(begin(set).cached) << "a splat that absorbs has another root";
    EXPECT_EQ(begin(set).tree->root_count(), 2);
    EXPECT_TRUE(begin(set).cached);
    set.position[2999].z += 0.001f;
    EXPECT_FALSE(begin(set).cached);
    set.id[2998] = 2999;
    set.id[2999] = 2998;
    EXPECT_FALSE(begin(set).cached) << "ids order what lies at one place";
    set.spacing = glm::dvec3(0.1);
    EXPECT_FALSE(begin(set).cached) << "a lattice is halved in its middle";
    set.position.pop_back();
    set.color.pop_back();
    set.alpha.pop_back();
    set.distance.pop_back();
    set.id.pop_back();
    EXPECT_FALSE(begin(set).cached);
    EXPECT_EQ(trees().size(), 6u);
}

TEST_F(KeptTreesTest, WhatIsDamagedIsBuiltAgainWithoutAWord) {
    const SplatSet set = cloud(5000);
    const fs::path file = begin(set).file;
    const auto whole = std::int64_t(fs::file_size(file));
    const std::int64_t header = 32, version = 8, rows = 16, nodes = 24;
    for (const std::int64_t place :
         {std::int64_t{0}, version, rows, nodes, header + 3, whole / 2, whole - 1}) {
        SCOPED_TRACE(place);
        std::fstream damaged(file, std::ios::binary | std::ios::in | std::ios::out);
        damaged.seekg(place);
        const auto byte = char(damaged.get() ^ 0x41);
        damaged.seekp(place).put(byte);
        damaged.close();
        const KeptTree kept = begin(set);
        EXPECT_FALSE(kept.cached);
        EXPECT_TRUE(same(*kept.tree, build_merge_tree(set)));
        EXPECT_TRUE(begin(set).cached);
    }
    for (const std::int64_t length : {std::int64_t{0}, header, whole - 1, whole / 3}) {
        SCOPED_TRACE(length);
        fs::resize_file(file, static_cast<std::uintmax_t>(length));
        EXPECT_FALSE(begin(set).cached);
        EXPECT_TRUE(begin(set).cached);
    }
    EXPECT_TRUE(said_.warnings.empty()) << said_.warnings.front();
}

TEST_F(KeptTreesTest, TreesCountInTheCachesLimitAndDriveOutNoSet) {
    begin(cloud(5000, 1));
    const auto bytes = std::int64_t(fs::file_size(trees().front()));
    const auto hour_ago = fs::file_time_type::clock::now() - std::chrono::hours(1);
    fs::last_write_time(trees().front(), hour_ago);
    folder_.file("cache/0.splats", std::string(std::size_t(6 * bytes), 'x'));
    cache_.limit_bytes = 8 * bytes;
    begin(cloud(5000, 2));
    EXPECT_EQ(trees().size(), 2u);
    begin(cloud(5000, 3));
    ASSERT_EQ(trees().size(), 2u) << "the one used longest ago makes room";
    for (const fs::path& file : trees()) EXPECT_GT(fs::last_write_time(file), hour_ago);
    cache_.limit_bytes = 8 * bytes - 8;
    EXPECT_FALSE(begin(cloud(5000, 4)).cached);
    EXPECT_FALSE(begin(cloud(5000, 4)).cached) << "more than an eighth";
    EXPECT_TRUE(fs::exists(cache_.folder / "0.splats"));
}

TEST_F(KeptTreesTest, WithoutACacheNothingIsWritten) {
    cache_.folder.clear();
    const KeptTree kept = begin(cloud(3000));
    EXPECT_TRUE(kept.file.empty());
    EXPECT_FALSE(kept.cached);
    EXPECT_TRUE(begin(SplatSet()).tree->nodes.empty());
}

TEST_F(KeptTreesTest, AFolderThatCannotBeWrittenCostsAWarning) {
    folder_.file("cache", "a file");
    EXPECT_FALSE(begin(cloud(3000)).cached);
    EXPECT_EQ(said_.warnings.size(), 1u);
}

TEST_F(KeptTreesTest, ALoaderKeepsTheTreesOfSetsThatAreLargerThanTheirSample) {
    Scene scene;
    scene.layers.resize(1);
    scene.layers[0].name = "gas";
    scene.layers[0].source.meshes = {{"plane", {}, 0.15}};
    scene.layers[0].source.count = 20'000;
    const auto load = [&](std::int64_t sample_limit) {
        SetLoader loader(cache_, sample_limit);
        loader.want(scene);
        loader.wait();
        const auto layer = loader.layer("gas");
        EXPECT_TRUE(layer && layer->arranged);
        return layer;
    };
    load(100'000);
    EXPECT_TRUE(trees().empty()) << "the sample is the set";
    const auto first = load(1000);
    ASSERT_EQ(trees().size(), 1u);
    const auto hour_ago = fs::file_time_type::clock::now() - std::chrono::hours(1);
    fs::last_write_time(trees().front(), hour_ago);
    const auto second = load(1000);
    EXPECT_GT(fs::last_write_time(trees().front()), hour_ago) << "it was read";
    EXPECT_TRUE(same(*first->whole.tree, *second->whole.tree));
}

// Previews of few splats must show the light of what they stand for: mean brightness, blocks of 64x64 px and
// the thickness of a disk seen from its edge.

constexpr int frame_width = 960, frame_height = 540;

float uniform(std::uint32_t i, std::uint32_t which) {
    return shared::as_uniform(shared::as_hash(11u, i, 0u, which));
}

/// Alpha of a two-armed spiral with a bulge at (x, z), radius 5.
double spiral(double x, double z) {
    const double r = std::sqrt(x * x + z * z);
    const double turn = real::atan2(z, x) - 1.6 * real::log(r + 0.2);
    const double arms = 0.5 + 0.5 * real::cos(2.0 * turn);
    const double disk = real::exp(-r / 2.2);
    return std::min(1.0, 0.9 * real::exp(-r * r / 0.8) + disk * (0.15 + 0.85 * arms * arms * arms));
}

/// A thick disk as generation leaves it: 8 million jittered lattice positions around the plane y = 0.
std::shared_ptr<const SplatSet> galaxy() {
    constexpr std::int64_t across = 452, up = 50;
    const glm::dvec3 spacing(10.0 / across, 0.8 / up, 10.0 / across);
    auto set = std::make_shared<SplatSet>();
    for (std::int64_t k = 0; k < across; ++k)
        for (std::int64_t j = 0; j < up; ++j)
            for (std::int64_t i = 0; i < across; ++i) {
                const auto n = std::uint32_t((k * up + j) * across + i);
                const glm::dvec3 p =
                    (glm::dvec3(i, j, k) + glm::dvec3(uniform(n, 1), uniform(n, 2), uniform(n, 3))) *
                        spacing -
                    glm::dvec3(5.0, 0.4, 5.0);
                if (p.x * p.x + p.z * p.z > 25.0) continue;
                const auto a = float(spiral(p.x, p.z));
                add_splat(*set, glm::vec3(p), {0.4f + 0.5f * a, 0.5f, 0.8f - 0.4f * a}, a);
                set->distance.back() = float(std::fabs(p.y));
                set->id.back() = n;
            }
    set->spacing = spacing;
    set->max_distance = 0.4;
    set->generated = true;
    return set;
}

Look galaxy_look() {
    Look look;
    look.pdf.shape = DensityCurve::Shape::smooth;
    look.vertical.shape = VerticalAlpha::Shape::linear;
    look.noise.resize(1);
    look.noise[0].silhouette = 0.4f;
    look.radius.min = 0.02f;
    look.radius.max = 0.05f;
    return look;
}

Camera camera_at(const glm::dvec3& position) {
    CameraParams params;
    params.position = position;
    params.fov = 40.0;
    Bounds box;
    box.add({-5.0, -0.4, -5.0});
    box.add({5.0, 0.4, 5.0});
    return make_camera(params, frame_width, frame_height, box);
}

struct View {
    const char* name;
    Blend blend;
    glm::dvec3 eye;
};

const glm::dvec3 tilted(3.0, 6.2, 8.4), edge_on(0.0, 0.6, 9.0), close(1.0, 0.8, 3.0);
const View views[] = {{"over, tilted", Blend::over, tilted},       {"over, edge on", Blend::over, edge_on},
                      {"over, close", Blend::over, close},         {"screen, tilted", Blend::screen, tilted},
                      {"screen, edge on", Blend::screen, edge_on}, {"add, tilted", Blend::add, tilted},
                      {"add, edge on", Blend::add, edge_on}};

/// A galaxy of more than eight million splats, which all views share, whole and as a preview draws it.
class Gallery {
  public:
    std::int64_t size() const { return set_->size(); }

    /// With every splat, and with a cut of so many.
    Image whole(const View& view) { return draw(view, merged(view.blend).splats); }
    Image cut(const View& view, std::int64_t budget) {
        LayerRender render;
        render.blend = view.blend;
        RenderLayer layer;
        layer.render = render;
        RenderSettings frame;
        frame.width = frame_width;
        frame.height = frame_height;
        const MergeSettings settings(render);
        const CutLayer seen{&merged(view.blend), &settings,
                            make_projection(layer, 0, camera_at(view.eye), frame)};
        const auto splats = cut_splats(std::span(&seen, 1), {budget, 1.5f, frame_width, frame_height});
        return draw(view, splats[0]);
    }

  private:
    Image draw(const View& view, const ShadedSplats& splats) {
        PreviewLayer layer;
        layer.layer.render.blend = view.blend;
        layer.layer.splats = &splats;
        return preview_.draw({layer}, {camera_at(view.eye), nullptr, frame_width, frame_height});
    }

    /// Kept for views one after the other that have the same look.
    const MergedSplats& merged(Blend blend) {
        if (blend_ == blend) return merged_;
        Look look = galaxy_look();
        LookInputs inputs;
        inputs.falloff_integral = falloff_integral({});
        if (blend == Blend::add) look.alpha.gain = 0.1f;
        if (blend == Blend::add) inputs.column = ColumnLaw::sum;
        merged_ = merge_splats(source_, apply_look(*set_, look, inputs));
        blend_ = blend;
        return merged_;
    }

    std::shared_ptr<const SplatSet> set_ = galaxy();
    MergeSource source_{set_, std::make_shared<const MergeTree>(build_merge_tree(*set_)), 1.0f};
    MergedSplats merged_;
    std::optional<Blend> blend_;
    DrawnPreview preview_;
};

void expect_light_of_the_whole(Gallery& gallery, const View& view) {
    const Image full = gallery.whole(view);
    for (const std::int64_t splats : {80000, 30000}) {
        if (splats < 80000 && view.eye == close) continue;  // where each is a tenth of the picture wide
        SCOPED_TRACE(fmt::format("{}, {} splats", view.name, splats));
        const test::ViewTruth truth =
            test::compare_frames(gallery.cut(view, splats), full, view.eye == edge_on);
        EXPECT_NEAR(truth.light, 1.0, 0.03);
        EXPECT_GT(truth.bright_blocks, 5);
        EXPECT_GE(truth.near, 0.95 * truth.bright_blocks) << "of " << truth.bright_blocks << " blocks";
        EXPECT_NEAR(truth.thickness, 1.0, 0.1);
    }
}

TEST(PreviewTruth, AHundredthAsManySplatsShowTheLightOfTheWhole) {
    Gallery gallery;
    ASSERT_GT(gallery.size(), 8000000);
    for (const View& view : views) expect_light_of_the_whole(gallery, view);
}

/// Moving views can be believed: six views of the shipped scenes, drawn by the viewer's own session with as
/// many splats as hold 24 frames a second on two cores, against their final frames.
constexpr std::int64_t splats_of_two_cores = 60'000;  // fewer than two cores drew at that rate

class PreviewViewsNightly : public test::GlTest {};

TEST_F(PreviewViewsNightly, MovingPicturesHaveTheLightOfTheFinalOnes) {
    const Quiet quiet;
    const TempFolder folder;
    for (const test::NamedView& view : test::preview_views()) {
        SCOPED_TRACE(view.name);
        const test::ViewTruth truth = test::measure_truth(view, splats_of_two_cores, {folder.path(), 0});
        EXPECT_LE(truth.shown, splats_of_two_cores);
        EXPECT_NEAR(truth.light, 1.0, 0.03);
        EXPECT_GT(truth.bright_blocks, 3);
        EXPECT_GE(truth.near, 0.9 * truth.bright_blocks) << "of " << truth.bright_blocks << " blocks";
        EXPECT_NEAR(truth.thickness, 1.0, 0.15);
        fmt::print("{}: light {:+.1f} %, {} of {} blocks, thickness {:+.0f} %\n", view.name,
                   100.0 * (truth.light - 1.0), truth.near, truth.bright_blocks,
                   100.0 * (truth.thickness - 1.0));
    }
}

}  // namespace
}  // namespace astrosplat
