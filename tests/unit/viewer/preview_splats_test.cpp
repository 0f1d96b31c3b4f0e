// How many splats a preview draws, and which.
#include "viewer/preview_splats.h"
#include "core/progress.h"
#include "image/blur.h"
#include "output/write.h"
#include "render/render.h"
#include "scene/layer_setup.h"
#include "sets/load_source.h"
#include "support/small_scene.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// The splats that a preview draws: all where there is room, what is kept between draws never shows, samples
// first and whole sets once their sums are there.

constexpr int width = 160, height = 100;
constexpr std::int64_t all = 1'000'000;

class PreviewSplatsTest : public testing::Test {
  protected:
    explicit PreviewSplatsTest(std::int64_t sample_limit = all) {
        for (const LayerParams& params : small.scene.layers) add(params, sample_limit);
    }

    void add(const LayerParams& params, std::int64_t sample_limit = all) {
        add(params, std::make_shared<const SplatSet>(load_source(params.source, params.name)), sample_limit);
    }
    void add(const LayerParams& params, const std::shared_ptr<const SplatSet>& set,
             std::int64_t sample_limit = all) {
        PreviewLayer layer;
        layer.layer = render_layer(params);
        layer.set = set;
        layer.look = look_of(params);
        layer.inputs = look_inputs(params);
        layers.push_back(layer);
        loaded.push_back(
            std::make_shared<const LoadedLayer>(whole_layer(set, params.source, params.name, sample_limit)));
    }

    Camera camera() const {
        Bounds box;
        box.add({-5.0, -5.0, -5.0});
        box.add({5.0, 5.0, 5.0});
        return make_camera(small.scene.camera, width, height, box);
    }
    PreviewView view() const { return {camera(), nullptr, width, height}; }
    Image draw(PreviewSplats& splats) const {
        std::vector<PreviewLayer> seen = layers;
        splats.cut(seen, loaded, view(), budget, least_px);
        DrawnPreview preview;
        return preview.draw(seen, view());
    }
    std::string hash(PreviewSplats& splats) const { return pixel_hash(draw(splats)); }
    std::string redrawn() const {
        PreviewSplats splats;
        return hash(splats);
    }
    Image rendered() const {
        std::vector<ShadedSplats> shaded;
        std::vector<RenderLayer> wanted;
        for (const PreviewLayer& layer : layers) {
            shaded.push_back(apply_look(*layer.set, layer.look, layer.inputs));
            wanted.push_back(layer.layer);
        }
        for (std::size_t i = 0; i < wanted.size(); ++i) wanted[i].splats = &shaded[i];
        RenderSettings picture;
        picture.width = width;
        picture.height = height;
        return render(wanted, camera(), nullptr, picture).beauty;
    }

    SmallScene small;
    std::vector<PreviewLayer> layers;
    std::vector<std::shared_ptr<const LoadedLayer>> loaded;
    std::int64_t budget = all;
    float least_px = 0.0f;
};

void wait(PreviewSplats& splats) {
    while (splats.lacks_sums()) {
        splats.refine(seconds_now());
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

double light_of(const Image& picture) {
    double sum = 0.0;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        if (i % 4 != 3) sum += picture.pixels[i];
    return sum;
}

TEST_F(PreviewSplatsTest, StarsAreNeverMergedOrLeftOut) {
    LayerParams stars;
    stars.name = "sky";
    stars.source.kind = SourceKind::stars;
    std::string rows = "ra,dec,dist,mag\n10,20,,1\n";  // one at infinity
    for (int i = 0; i < 300; ++i) rows += std::to_string(i) + ",-10,5,3\n";
    stars.source.stars.catalogue = small.folder.file("near.csv", rows);
    add(stars, 10);
    EXPECT_LT(loaded.back()->box.hi.x, 6.0);  // of those that have a place
    EXPECT_TRUE(loaded.back()->arranged);
    std::swap(layers[0], layers[2]);
    std::swap(loaded[0], loaded[2]);
    PreviewSplats splats;
    const Image picture = draw(splats), wanted = rendered();
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        ASSERT_NEAR(picture.pixels[i], wanted.pixels[i], 1e-5f * std::max(1.0f, wanted.pixels[i]));
    budget = 10;
    std::vector<PreviewLayer> seen = layers;
    seen[0].look.grade.gain = 2.0f;
    splats.cut(seen, loaded, view(), budget, least_px);
    EXPECT_EQ(seen[0].layer.splats->size(), 301);
    EXPECT_EQ(seen[0].layer.splats->color[0], 2.0f * loaded[0]->set->color[0]);
    EXPECT_LE(seen[1].layer.splats->size() + seen[2].layer.splats->size(), 10);
    EXPECT_EQ(splats.kept()[0], 1.0);
    EXPECT_FALSE(splats.refine(seconds_now()));
}

TEST_F(PreviewSplatsTest, WithRoomForAllSplatsTheFrameIsTheRenderers) {
    PreviewSplats splats;
    const Image picture = draw(splats), wanted = rendered();
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        ASSERT_NEAR(picture.pixels[i], wanted.pixels[i], 1e-5f * std::max(1.0f, wanted.pixels[i]));
}

TEST_F(PreviewSplatsTest, AFewSplatsHaveTheLightOfAll) {
    budget = layers[0].set->size() / 20;
    PreviewSplats splats;
    EXPECT_NEAR(light_of(draw(splats)) / light_of(rendered()), 1.0, 0.03);
}

/// A picture's splats lie in rows, as those of a lattice do; seen at an angle their cells are longer than
/// wide.
TEST_F(PreviewSplatsTest, BodiesHaveNoStripes) {
    layers.clear();
    loaded.clear();
    auto body = std::make_shared<SplatSet>();
    constexpr int side = 64, deep = 8;
    for (int i = 0; i < side * side * deep; ++i) {
        const float x = float(i % side), y = float(i / side % side), z = float(i / side / side);
        const float tilt = 1.2f, step = 6.0f / float(side), up = (y - 0.5f * float(side)) * step;
        body->position.push_back({(x - 0.5f * float(side)) * step, up * std::cos(tilt) + z * step,
                                  up * std::sin(tilt) - z * step});
        body->color.push_back(glm::vec3(0.5f));
        body->alpha.push_back(0.02f);
        body->distance.push_back(0.0f);
        body->radius.push_back(1.5f * step);
        body->id.push_back(std::uint64_t(i));
    }
    LayerParams params = small.scene.layers[0];
    params.look = {};
    add(params, body);
    budget = body->size() / 64;
    PreviewSplats splats;
    const Image picture = draw(splats), wanted = rendered();
    double off = 0.0, all_light = 0.0;
    for (std::size_t i = 0; i < picture.pixels.size(); i += 4) {
        off += std::fabs(double(picture.pixels[i]) - double(wanted.pixels[i]));
        all_light += double(wanted.pixels[i]);
    }
    EXPECT_LT(off / all_light, 0.075) << "6 % in rows, 9 % as one splat each";
}

TEST_F(PreviewSplatsTest, WhatIsKeptNeverShows) {
    PreviewSplats kept;
    std::vector<std::string> seen = {hash(kept)};
    const auto changed = [&](const auto& change) {
        change();
        seen.push_back(hash(kept));
        EXPECT_EQ(seen.back(), redrawn()) << "change " << seen.size() - 1;
        EXPECT_NE(seen.back(), seen[seen.size() - 2]) << "change " << seen.size() - 1;
    };
    changed([&] { budget = 2000; });
    changed([&] { budget = 500; });
    changed([&] { layers[0].look.grade.gain = 0.5f; });
    changed([&] { small.scene.camera.position = glm::dvec3(0.0, 9.0, 2.0); });
    changed([&] { layers[1].layer.render.blend = Blend::add; });
    changed([&] { layers[1].layer.render.opacity = 0.4f; });
    changed([&] { layers[1].layer.render.falloff.shape = Falloff::Shape::linear; });
    changed([&] { layers[1].inputs.column = ColumnLaw::sum; });
    changed([&] { budget = 5000; });
    changed([&] {
        std::swap(layers[0], layers[1]);
        std::swap(loaded[0], loaded[1]);
        layers[0].layer.render.isolate = true;
    });
    changed([&] {
        layers.erase(layers.begin());
        loaded.erase(loaded.begin());
    });
}

TEST_F(PreviewSplatsTest, LargeSplatsAreNotSplitUp) {
    const std::string wanted = redrawn();
    for (PreviewLayer& layer : layers) layer.layer.render.lod.max_px = 4.0f;
    EXPECT_EQ(redrawn(), wanted);
}

TEST_F(PreviewSplatsTest, ALookThatCannotBeAppliedIsRefusedUntilItCan) {
    PreviewSplats splats;
    const std::string before = hash(splats);
    layers[0].look.noise.assign(9, Noise{});
    for (Noise& noise : layers[0].look.noise) noise.jitter = 0.1f;
    for (int i = 0; i < 2; ++i) EXPECT_THROW(hash(splats), InputError);
    layers[0].look.noise.clear();
    EXPECT_EQ(hash(splats), before);
}

TEST_F(PreviewSplatsTest, NoLayersAndEmptySets) {
    const auto nothing = std::make_shared<const SplatSet>();
    layers.pop_back();
    loaded.pop_back();
    layers[0].set = nothing;
    loaded[0] = std::make_shared<const LoadedLayer>(whole_layer(nothing, {}, "nothing", all));
    PreviewSplats splats;
    EXPECT_EQ(light_of(draw(splats)), 0.0);
    layers.clear();
    loaded.clear();
    EXPECT_EQ(light_of(draw(splats)), 0.0);
}

class SampledSplatsTest : public PreviewSplatsTest {
  protected:
    SampledSplatsTest() : PreviewSplatsTest(1500) {}
    void arrange() {
        for (auto& layer : loaded)
            if (!layer->arranged)
                layer = std::make_shared<const LoadedLayer>(
                    arranged_layer(*layer, std::make_shared<const MergeTree>(build_merge_tree(*layer->set))));
    }
};

/// Sums of a dragged look would come too late, and their making would slow the preview down.
TEST_F(SampledSplatsTest, WholeSetsWaitUntilALookIsAtRest) {
    arrange();
    budget = 3000;
    PreviewSplats splats;
    double now = 100.0;
    for (const float gain : {0.9f, 0.8f, 0.7f}) {
        layers[0].look.grade.gain = gain;
        draw(splats);
        for (int i = 0; i < 20; ++i) {  // as long as sums take many times over, of which 60 ms are counted
            EXPECT_FALSE(splats.refine(now += 0.003));
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        EXPECT_TRUE(splats.lacks_sums());
    }
    now += 0.1;
    while (splats.lacks_sums()) {
        splats.refine(now);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

TEST_F(SampledSplatsTest, ASampleComesFirstAndTheWholeSetOnceItsSumsAreThere) {
    ASSERT_GT(layers[0].set->size(), 1500);
    budget = 3000;
    PreviewSplats splats;
    EXPECT_NEAR(light_of(draw(splats)) / light_of(rendered()), 1.0, 0.15);
    EXPECT_FALSE(splats.lacks_sums()) << "there is no tree of the whole";
    arrange();
    const std::string sampled = hash(splats);
    wait(splats);
    const Image whole = draw(splats);
    EXPECT_NE(pixel_hash(whole), sampled);
    EXPECT_FALSE(splats.refine(seconds_now())) << "nothing is missing";
    EXPECT_NEAR(light_of(whole) / light_of(rendered()), 1.0, 0.03);
    layers[0].look.grade.gain = 0.5f;
    const std::string dimmed = hash(splats);
    wait(splats);
    EXPECT_EQ(hash(splats), dimmed) << "half the light, to the bit";
    layers[0].look.density = 0.5f;
    const std::string edited = hash(splats);
    wait(splats);
    EXPECT_NE(hash(splats), edited);
}

/// The splats of a moved camera with what the look did to them, whatever it did.
TEST_F(SampledSplatsTest, AnEditedLookIsShownAsAMovedCameraIs) {
    arrange();
    budget = 3000;
    PreviewSplats splats;
    draw(splats);
    wait(splats);
    const auto off = [](const Image& a, const Image& b) {
        double sum = 0.0;
        for (std::size_t i = 0; i < a.pixels.size(); ++i)
            sum += std::pow(double(a.pixels[i]) - double(b.pixels[i]), 2.0);
        return std::sqrt(sum);
    };
    const std::function<void(Look&)> edits[] = {
        [](Look& look) { look.grade.gain = 0.4f; },
        [](Look& look) { look.density = 0.6f; },
        [](Look& look) { look.alpha.power = 1.6f; },
        [](Look& look) { look.reach = 0.2f; },
    };
    for (const auto& edit : edits) {
        for (PreviewLayer& layer : layers) edit(layer.look);
        const Image edited = draw(splats), wanted = rendered();
        EXPECT_TRUE(splats.whole());
        EXPECT_TRUE(splats.lacks_sums());
        wait(splats);
        const Image moved = draw(splats);
        EXPECT_NEAR(light_of(edited) / light_of(wanted), 1.0, 0.03) << &edit - edits;
        PreviewSplats without_sums;
        const Image sampled = draw(without_sums);
        EXPECT_LT(off(edited, wanted), 0.7 * off(sampled, wanted)) << &edit - edits;
        EXPECT_LT(off(edited, wanted), 2.0 * off(moved, wanted)) << &edit - edits;
    }
}

// The budget against machines of known speed, and steps of more splats at rest.

/// Milliseconds of a frame: a fixed part and so much per thousand splats.
struct Machine {
    double fixed_ms, ms_per_thousand;
    double frame(std::int64_t splats) const { return fixed_ms + ms_per_thousand * double(splats) / 1000.0; }
    friend void PrintTo(const Machine& given, std::ostream* out) {
        *out << given.fixed_ms << " ms and " << given.ms_per_thousand << " per thousand";
    }
};

/// Runs `frames` frames with all the splats one may ask for.
void run(PreviewBudget& budget, const Machine& machine, double target_ms, int frames) {
    for (int i = 0; i < frames; ++i) budget.measured(machine.frame(budget.splats), target_ms, budget.splats);
}

class Budget : public testing::TestWithParam<Machine> {};

TEST_P(Budget, ReachesTheTargetAndStaysThere) {
    for (const std::int64_t start : {30000, 200000, 3000000}) {
        PreviewBudget budget;
        budget.splats = start;
        run(budget, GetParam(), 25.0, 150);
        const double reached = GetParam().frame(budget.splats);
        EXPECT_GT(reached, 25.0 / 1.13) << "from " << start;
        EXPECT_LT(reached, 25.0 / 0.87) << "from " << start;
        const std::int64_t steady = budget.splats;
        for (int i = 0; i < 50; ++i) {
            run(budget, GetParam(), 25.0, 1);
            ASSERT_EQ(budget.splats, steady);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Machines, Budget,
                         testing::Values(Machine{6.0, 0.05}, Machine{15.0, 0.1}, Machine{1.0, 0.02},
                                         Machine{0.0, 0.3}));

TEST(PreviewBudgetTest, FewSplatsGetFewerPixelsAndManyAllOfThem) {
    PreviewBudget budget;
    run(budget, {1.0, 0.05}, 25.0, 100);
    EXPECT_EQ(budget.pixels, 1);
    run(budget, {20.0, 0.5}, 25.0, 100);
    EXPECT_EQ(budget.pixels, 2);
    run(budget, {20.0, 0.1}, 25.0, 100);
    EXPECT_EQ(budget.pixels, 2) << "there are few still";
    run(budget, {1.0, 0.02}, 25.0, 100);
    EXPECT_EQ(budget.pixels, 1);
}

TEST_F(PreviewSplatsTest, AFourthOfThePixelsHasTheSameLight) {
    PreviewSplats splats;
    for (const int odd : {0, 1}) {
        PreviewView whole = view();
        whole.width -= odd;
        whole.height -= odd;
        std::vector<PreviewLayer> seen = layers;
        splats.cut(seen, loaded, whole, budget, least_px);
        DrawnPreview preview;
        const Image wanted = preview.draw(seen, whole);
        const PreviewView half = halved(whole);
        EXPECT_EQ(half.width, width / 2);
        const Image got = doubled(preview.draw(seen, half), whole.width, whole.height);
        ASSERT_EQ(got.width, wanted.width);
        ASSERT_EQ(got.height, wanted.height);
        EXPECT_NEAR(light_of(got) / light_of(wanted), 1.0, 0.01);
        double off = 0.0, all = 0.0;
        for (std::size_t i = 0; i < got.pixels.size(); ++i) {
            off += std::fabs(double(got.pixels[i]) - double(wanted.pixels[i]));
            all += double(wanted.pixels[i]);
        }
        EXPECT_LT(off, 0.1 * all) << "it lies elsewhere";
    }
}

TEST(PreviewBudgetTest, NeverFallsBelowTheLeast) {
    PreviewBudget budget;
    run(budget, {100.0, 1.0}, 25.0, 100);
    EXPECT_EQ(budget.splats, budget.least);
}

TEST(PreviewBudgetTest, NeverRisesAboveTheMost) {
    PreviewBudget budget;
    run(budget, {1.0, 0.0}, 25.0, 200);
    EXPECT_EQ(budget.splats, budget.most);
}

TEST(PreviewBudgetTest, ASlowFrameAmongOthersChangesNothing) {
    PreviewBudget budget;
    const std::int64_t before = budget.splats;
    for (int i = 0; i < 100; ++i) budget.measured(i % 5 == 3 ? 90.0 : 25.0, 25.0, budget.splats);
    EXPECT_EQ(budget.splats, before);
}

TEST(PreviewBudgetTest, FewerSplatsThanTheBudgetDoNotRaiseIt) {
    PreviewBudget budget;
    const std::int64_t before = budget.splats;
    for (int i = 0; i < 50; ++i) budget.measured(3.0, 25.0, 6000);
    EXPECT_EQ(budget.splats, before);
}

TEST(PreviewBudgetTest, FarTooSlowIsMendedWithinAFewFrames) {
    PreviewBudget budget;
    budget.splats = 2000000;
    const Machine machine{5.0, 0.1};
    run(budget, machine, 25.0, 12);
    EXPECT_LT(machine.frame(budget.splats), 50.0);
}

TEST(FramePace, LeavesTimeForTheRestOfTheWindow) {
    FramePace pace;
    EXPECT_DOUBLE_EQ(pace.target_ms(5.0, 25.0), 25.0);  // nothing known
    pace.drew(20.0);
    EXPECT_NEAR(pace.target_ms(5.050, 25.0), 1000.0 / 24.0 - 30.0, 1e-9);  // 30 ms besides the preview
    pace.drew(12.0);
    EXPECT_NEAR(pace.target_ms(5.122, 25.0), 1000.0 / 24.0 - 30.0, 1e-9);  // a slower frame says nothing
    pace.drew(12.0);
    EXPECT_DOUBLE_EQ(pace.target_ms(5.139, 25.0), 25.0);  // 5 ms besides it
    pace.drew(25.0);
    EXPECT_DOUBLE_EQ(pace.target_ms(6.0, 25.0), 25.0);  // after a pause, nothing known
    pace.drew(20.0);
    EXPECT_DOUBLE_EQ(pace.target_ms(6.1, 25.0), 10.0);  // never less
}

TEST(FinerSteps, StepsAreSharesThatTheTimeAllows) {
    constexpr std::int64_t galaxy = 9'400'000;
    EXPECT_EQ(splats_of_step(1, galaxy, 81'000, 0.03, 0.4), 470'000);
    EXPECT_EQ(splats_of_step(2, galaxy, 470'000, 0.1, 0.4), 1'880'000);
    EXPECT_EQ(splats_of_step(2, galaxy, 470'000, 0.2, 0.4), 940'000) << "which take 0.4 s";
    EXPECT_EQ(splats_of_step(2, galaxy, 470'000, 0.2, 0.0), 1'880'000) << "whatever it takes";
    EXPECT_EQ(splats_of_step(1, 100'000, 60'000, 0.01, 0.4), 0) << "fewer than there are";
    EXPECT_EQ(splats_of_step(3, galaxy, 81'000, 0.01, 0.4), 0) << "there is no such step";
}

TEST(FinerSteps, QuickFinalFramesAreNotHeldUp) {
    EXPECT_EQ(plan_steps(-1.0).count, 2) << "not known yet";
    EXPECT_EQ(plan_steps(5.0).count, 2);
    EXPECT_EQ(plan_steps(1.7).count, 1);
    EXPECT_LE(plan_steps(1.7).most_s, 0.09) << "within the rest before it";
    EXPECT_EQ(plan_steps(0.2).count, 0);
}

}  // namespace
}  // namespace astrosplat
