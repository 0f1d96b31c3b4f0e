// The same bits whatever shares the work or holds the splats, and the reference renderer's picture; and what
// becomes of a frame whose device fails.
#include "camera/camera.h"
#include "core/rotation.h"
#include "render/device.h"
#include "render/frame.h"
#include "render/frame_job.h"
#include "render/render.h"
#include "render/scatter.h"
#include "support/printing.h"
#include "support/reference_renderer.h"
#include "support/test.h"
#include "unit/render/random_scene.h"
#include "unit/render/scenes.h"
#include "unit/render/sphere_scenes.h"

namespace astrosplat::test {
namespace {

// The same bits for any number of threads, tile size, instruction set, memory limit, region, and with the C
// library's FMA variants out of reach (the command-line tests do that one).

constexpr int width_px = 211, height_px = 133;

struct CloudScene {
    ShadedSplats sets[6] = {cloud(1000, 1), cloud(800, 2), cloud(600, 3),
                            cloud(400, 4),  cloud(300, 5), cloud(400, 6)};
    std::vector<RenderLayer> layers;
    Camera camera;

    explicit CloudScene(bool only_over = false) {
        const Blend blends[6] = {Blend::over,   Blend::add,     Blend::screen,
                                 Blend::hybrid, Blend::lighten, Blend::absorb};
        for (std::size_t i = 0; i < 6; ++i) {
            RenderLayer layer = layer_of("layer", sets[i], only_over ? Blend::over : blends[i],
                                         all_shapes[i % all_shapes.size()]);
            layer.axis = {0.3, 0.9, 0.1};
            layer.render.lod.max_px = i == 1 || i == 3 ? 40.0f : 0.0f;
            layer.render.lod.max_children = 256;
            layers.push_back(layer);
        }
        camera.eye = {0.0, 0.0, 9.0};
        camera.focal_px = 160.0;
        camera.center_x_px = width_px * 0.5;
        camera.center_y_px = height_px * 0.5;
    }

    Image picture(RenderSettings settings = settings_of(width_px, height_px)) const {
        return render(layers, camera, nullptr, settings).beauty;
    }
};

class Invariance : public ::testing::TestWithParam<bool> {};

TEST_P(Invariance, HoweverThePictureIsMade) {
    const CloudScene scene(GetParam());
    expect_same_picture([&](const RenderSettings& settings) { return scene.picture(settings); },
                        settings_of(width_px, height_px), 200000, {{37, 21, 90, 71}});
}

TEST_P(Invariance, BandsDrawTheSplatsOfTheWhole) {
    const CloudScene scene(GetParam());
    RenderSettings settings = settings_of(width_px, height_px);
    const auto drawn = [&] {
        return render(scene.layers, scene.camera, nullptr, settings).statistics.splats_drawn;
    };
    const auto whole = drawn();
    settings.memory_limit_bytes = 200000;
    EXPECT_EQ(drawn(), whole);
}

TEST_P(Invariance, CacheKeepsNothingThatShows) {
    const CloudScene scene(GetParam());
    RenderCache cache;
    const RenderSettings settings = settings_of(width_px, height_px);
    const Image first = render(scene.layers, scene.camera, nullptr, settings, {}, &cache).beauty;
    Camera moved = scene.camera;
    moved.eye.x = 2.0;
    render(scene.layers, moved, nullptr, settings, {}, &cache);
    EXPECT_EQ(first.pixels, render(scene.layers, scene.camera, nullptr, settings, {}, &cache).beauty.pixels);
}

INSTANTIATE_TEST_SUITE_P(AllBlendsAndOverAlone, Invariance, ::testing::Bool());

// Turning the camera in place changes neither order nor hybrid: a picture seen through two cameras turned
// against each other has the same light.
TEST(Camera, TurningInPlaceKeepsTheLight) {
    const ShadedSplats set = cloud(2000, 9);
    RenderLayer layer = layer_of("one", set, Blend::hybrid, Falloff::Shape::gaussian);
    Camera camera;
    camera.eye = {0.0, 0.0, 60.0};
    camera.focal_px = 800.0;
    camera.center_x_px = camera.center_y_px = 128.0;
    const Image straight = render({&layer, 1}, camera, nullptr, settings_of(256, 256)).beauty;
    camera.world_from_camera = rotation_from_degrees({0.4, -0.3, 35.0});
    const Image turned = render({&layer, 1}, camera, nullptr, settings_of(256, 256)).beauty;
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(total(turned, k) / total(straight, k), 1.0, 2e-3);
}

// The tile renderer against the reference renderer, which is the method on one page.

/// Relative to the larger of 1 and the reference.
struct Differences {
    double mean = 0.0, largest = 0.0;
    std::string place;
};

Differences differences(const Image& got, const Image& reference) {
    Differences d;
    for (std::size_t i = 0; i < got.pixels.size(); ++i) {
        const double here =
            std::fabs(got.pixels[i] - reference.pixels[i]) / std::max(1.0f, reference.pixels[i]);
        d.mean += here / double(got.pixels.size());
        if (here <= d.largest) continue;
        d.largest = here;
        const auto n = std::int64_t(i) / got.channels;
        d.place = "channel " + std::to_string(i % 4) + " of pixel " + std::to_string(n % got.width) + ", " +
                  std::to_string(n / got.width) + ": " + std::to_string(got.pixels[i]) + " instead of " +
                  std::to_string(reference.pixels[i]);
    }
    return d;
}

Environment sky() {
    auto faces = std::make_shared<EnvironmentFaces>();
    Image one = make_image(4, 2, 3);
    for (std::size_t i = 0; i < one.pixels.size(); ++i) one.pixels[i] = 0.1f + 0.05f * float(i % 7);
    faces->push_back({one});
    return {faces, glm::dmat3(1.0), 1.0f, 0.4f, 0.4f};
}

std::string describe(const RandomScene& scene) {
    std::string text;
    for (const RenderLayer& layer : scene.layers) {
        const LayerRender& r = layer.render;
        text += " | " + testing::PrintToString(r.falloff.shape) + " " + testing::PrintToString(r.blend) +
                (r.holdout ? " holdout" : "") + (r.isolate ? " isolated" : "");
    }
    return text;
}

/// Splats with a hard rim: there a table is least like what it stands for.
bool has_rims(const RandomScene& scene) {
    return std::any_of(scene.layers.begin(), scene.layers.end(), [](const RenderLayer& layer) {
        const Falloff& falloff = layer.render.falloff;
        return falloff.shape == Falloff::Shape::constant ||
               (falloff.shape == Falloff::Shape::trapezoid && falloff.core > 0.6f);
    });
}

void expect_agreement(std::uint32_t first_seed, std::uint32_t last_seed) {
    const Environment environment = sky();
    for (std::uint32_t seed = first_seed; seed <= last_seed; ++seed) {
        const RandomScene scene(seed, 10);
        const Environment* const behind = seed % 3 == 0 ? &environment : nullptr;
        const Image reference = reference_render(scene.layers, scene.camera, behind, scene.settings);
        const Image got = render(scene.layers, scene.camera, behind, scene.settings).beauty;
        const Differences d = differences(got, reference);
        EXPECT_LT(d.mean, 1e-4) << "seed " << seed << describe(scene);
        EXPECT_LT(d.largest, has_rims(scene) ? 5e-3 : 1e-3) << "seed " << seed << describe(scene) << "\n"
                                                            << d.place;
    }
}

TEST(Reference, RandomScenesAreThoseOfTheTileRenderer) { expect_agreement(1, 12); }

TEST(Reference, MoreRandomScenesAreThoseOfTheTileRendererNightly) { expect_agreement(13, 120); }

// Many splats that are not round, onto the sphere, all around the eye: the same bits for every tile size,
// number of threads, region and instruction set, those of round splats among them, and no seam.

constexpr Random drawn{13};

/// Ellipsoids and balls of all sizes all around the eye, some across every seam and pole.
struct EllipsesAround {
    ShadedSplats stretched, round;
    std::vector<RenderLayer> layers;

    EllipsesAround(Blend blend, Falloff::Shape shape) {
        for (ShadedSplats* set : {&stretched, &round}) {
            std::vector<OneSplat> splats;
            for (std::uint32_t i = 0; i < 700; ++i) {
                const std::uint32_t n = i + (set == &round ? 5000u : 0u);
                const double height = 2.0 * drawn(n, 1) - 1.0;
                const float size = drawn(n, 3);
                splats.push_back(
                    {glm::vec3(direction(360.0 * drawn(n, 2), real::degrees(real::asin(height)))) *
                         (2.0f + std::floor(drawn(n, 4) * 8.0f)),
                     0.01f + 1.5f * size * size * size * size,
                     drawn(n, 5),
                     {drawn(n, 6), drawn(n, 7), drawn(n, 8)}});
            }
            *set = make_splats(splats);
        }
        for (std::uint32_t i = 0; i < 700; ++i) {
            glm::mat3 stretch = glm::mat3(
                rotation_from_degrees({360.0 * drawn(i, 20), 360.0 * drawn(i, 21), 360.0 * drawn(i, 23)}));
            stretch[1] *= 0.02f + drawn(i, 22);
            stretch[2] *= 0.3f;
            stretched.stretch.push_back(stretch);
        }
        layers = {layer_of("round", round, Blend::over, Falloff::Shape::gaussian),
                  layer_of("stretched", stretched, blend, shape)};
        for (RenderLayer& layer : layers) layer.render.opacity = 0.6f;
    }
    Image picture(const Camera& camera,
                  const RenderSettings& settings = settings_of(wide_px, high_px)) const {
        return render(layers, camera, nullptr, settings).beauty;
    }
};

class SphereEllipsesBits : public ::testing::TestWithParam<Projection> {
  protected:
    EllipsesAround scene{
        GetParam() == Projection::fisheye ? Blend::screen : Blend::over,
        GetParam() == Projection::cylindrical ? Falloff::Shape::constant : Falloff::Shape::gaussian};
    Camera camera = wide_camera(GetParam());
};

TEST_P(SphereEllipsesBits, AreTheSameHoweverThePictureIsMade) {
    expect_same_picture([&](const RenderSettings& settings) { return scene.picture(camera, settings); },
                        settings_of(wide_px, high_px), 100000, {{401, 10, 111, 200}});
}

INSTANTIATE_TEST_SUITE_P(All, SphereEllipsesBits, ::testing::ValuesIn(projections));

// Black ellipsoids, too faint to hide anything, change no bit of what is round.
TEST(SphereEllipses, RoundSplatsKeepTheirBitsAmongOthers) {
    for (const Falloff::Shape shape : {Falloff::Shape::gaussian, Falloff::Shape::trapezoid}) {
        EllipsesAround scene(Blend::over, Falloff::Shape::gaussian);
        scene.layers[0].render.falloff.shape = shape;
        scene.layers[1].render.opacity = 1e-30f;
        for (glm::vec3& color : scene.stretched.color) color = glm::vec3(0.0f);
        const Camera camera = camera_of(Projection::equirectangular);
        const Image both = scene.picture(camera);
        scene.layers.pop_back();
        const Image alone = scene.picture(camera);
        for (std::size_t i = 0; i < alone.pixels.size(); i += 4)
            for (std::size_t k = i; k < i + 3; ++k) ASSERT_EQ(both.pixels[k], alone.pixels[k]) << k;
    }
}

TEST(SphereEllipses, HasNoSeam) {
    const EllipsesAround scene(Blend::over, Falloff::Shape::gaussian);
    expect_no_seam([&](const Camera& camera) { return scene.picture(camera); }, 0.012);
}

// Splats that come by the block give the bits that they give in memory: whatever the memory limit, the blocks
// and the threads are, for every blend that has an order and those that have none, with level of detail,
// through every lens.

/// A cloud around the origin, with planes of equal depths, and some splats all at one place.
ShadedSplats cloud_around_origin(std::uint32_t count, std::uint32_t seed) {
    ShadedSplats splats = cloud(count, seed, 1.2f);
    for (std::size_t i = 0; i < splats.position.size(); ++i)
        splats.position[i] =
            i % 16 == 0 ? glm::vec3(0.1f, -0.2f, 0.3f) : splats.position[i] - glm::vec3(0, 0, 3);
    return splats;
}

/// The splats of a set in space, some to a block, as a file may have them: ids in no order.
class BlocksInMemory : public ShadedBlocks {
  public:
    BlocksInMemory(const ShadedSplats& set, std::size_t rows_per_block) : set_(set) {
        rows_.resize(std::size_t(set.size()));
        std::iota(rows_.begin(), rows_.end(), std::size_t{0});
        const auto cell = [&](std::size_t row) {
            const glm::vec3 p = glm::floor(set.position[row] / 2.0f);
            return std::tuple(p.x, p.y, p.z, shared::as_hash(3u, std::uint32_t(row), 0u, 0u));
        };
        std::ranges::stable_sort(rows_, {}, cell);
        splats_ = set.size();
        for (std::size_t begin = 0; begin < rows_.size(); begin += rows_per_block) {
            BlockFacts facts;
            facts.first_sample = sample_.size();
            begins_.push_back(begin);
            const std::size_t end = std::min(rows_.size(), begin + rows_per_block);
            for (std::size_t i = begin; i < end; ++i) {
                const std::size_t row = rows_[i];
                const glm::vec3& c = set.color[row];
                facts.box.add(glm::dvec3(set.position[row]));
                facts.radius = std::max(facts.radius, set.radius[row]);
                largest_light_ = std::max(largest_light_, set.alpha[row] * std::max({c.x, c.y, c.z}));
                if (i % 8 == 0) add(row, sample_);
            }
            facts.splats = std::int64_t(end - begin);
            blocks_.push_back(facts);
        }
        begins_.push_back(rows_.size());
        blocks_.push_back({{}, 0.0f, 0, sample_.size()});
    }

    void shade(std::size_t block, ShadedSplats& out) const override {
        ++made;
        for_each_array(out, [](auto& array) { array.clear(); });
        for (std::size_t i = begins_[block]; i < begins_[block + 1]; ++i) add(rows_[i], out);
    }

    mutable std::atomic<int> made{0};

  private:
    void add(std::size_t row, ShadedSplats& to) const {
        to.position.push_back(set_.position[row]);
        to.color.push_back(set_.color[row]);
        to.alpha.push_back(set_.alpha[row]);
        to.radius.push_back(set_.radius[row]);
        to.id.push_back(set_.id[row]);
    }

    const ShadedSplats& set_;
    std::vector<std::size_t> rows_, begins_;
};

constexpr int block_wide = 97, block_high = 61;  // px of their pictures

struct Sky {
    std::vector<ShadedSplats> sets;
    std::vector<RenderLayer> layers;
    std::vector<std::unique_ptr<BlocksInMemory>> blocks;
    Camera camera;
    RenderSettings settings = settings_of(block_wide, block_high);

    explicit Sky(const std::vector<Blend>& blends, float lod_px = 0.0f, std::uint32_t count = 1500) {
        sets.reserve(blends.size());
        for (std::size_t i = 0; i < blends.size(); ++i) {
            sets.push_back(cloud_around_origin(count, std::uint32_t(i + 1)));
            RenderLayer layer =
                layer_of("layer", sets.back(), blends[i], all_shapes[1 + i % (all_shapes.size() - 1)]);
            layer.axis = {0.3, 0.9, 0.1};
            layer.translate = {0.1 * double(i), 0.0, 0.0};
            layer.scale = 1.0 + 0.2 * double(i);
            layer.render.lod.max_px = lod_px;
            layer.render.lod.max_children = 64;
            layer.render.lod.noise = lod_px > 0.0f ? 0.7f : 0.0f;
            layers.push_back(layer);
        }
        camera.eye = {0.3, 0.2, 6.0};
        camera.focal_px = 70.0;
        camera.center_x_px = block_wide * 0.5;
        camera.center_y_px = block_high * 0.5;
    }

    /// The layers, those whose number is in `streamed` by the block.
    std::vector<RenderLayer> by_block(std::size_t rows, const std::vector<std::size_t>& streamed) {
        std::vector<RenderLayer> some = layers;
        blocks.clear();
        for (const std::size_t i : streamed) {
            blocks.push_back(std::make_unique<BlocksInMemory>(sets[i], rows));
            some[i].splats = nullptr;
            some[i].blocks = blocks.back().get();
        }
        return some;
    }

    int made() const {
        int sum = 0;
        for (const auto& each : blocks) sum += each->made;
        return sum;
    }

    /// `little`: bytes that are to make slabs.
    void expect_same_bits(const std::vector<std::size_t>& streamed, std::int64_t little = 100000) {
        const RenderedFrame whole = render(layers, camera, nullptr, settings);
        EXPECT_GT(total(whole.beauty, 3) + total(whole.beauty, 0), 0.01);
        const int before = thread_count();
        // Rows of a block, bytes, threads.
        const std::tuple<std::size_t, std::int64_t, int> ways[] = {
            {1000, 0, 2}, {97, 2 * little, 1}, {97, 2 * little, 3}, {61, little, 2}};
        for (const auto& [rows, limit, threads] : ways) {
            const std::vector<RenderLayer> some = by_block(rows, streamed);
            RenderSettings limited = settings;
            limited.memory_limit_bytes = limit;
            set_thread_count(threads);
            SCOPED_TRACE(testing::Message()
                         << rows << " rows, " << limit << " bytes, " << threads << " threads");
            const RenderedFrame frame = render(some, camera, nullptr, limited);
            EXPECT_EQ(whole.beauty.pixels, frame.beauty.pixels);
            EXPECT_EQ(whole.depth.pixels, frame.depth.pixels);
            EXPECT_EQ(whole.coverage.pixels, frame.coverage.pixels);
            EXPECT_EQ(whole.count.pixels, frame.count.pixels);
            ASSERT_EQ(whole.layers.size(), frame.layers.size());
            for (std::size_t i = 0; i < whole.layers.size(); ++i)
                EXPECT_EQ(whole.layers[i].pixels, frame.layers[i].pixels) << i;
            EXPECT_EQ(whole.statistics.splats_drawn, frame.statistics.splats_drawn);
            EXPECT_EQ(whole.statistics.splats_in, frame.statistics.splats_in);
        }
        set_thread_count(before);
    }
};

const std::vector<Blend> affine = {Blend::over, Blend::add, Blend::screen, Blend::hybrid, Blend::absorb};

TEST(ByTheBlock, EveryBlendAlone) {
    for (const Blend blend :
         {Blend::over, Blend::add, Blend::screen, Blend::hybrid, Blend::absorb, Blend::lighten}) {
        SCOPED_TRACE(int(blend));
        Sky({blend}).expect_same_bits({0});
    }
}

TEST(ByTheBlock, LayersAmongEachOther) { Sky(affine).expect_same_bits({0, 2, 3}); }

TEST(ByTheBlock, IsolatedLayersHoldoutsAndDust) {
    Sky sky({Blend::over, Blend::lighten, Blend::add, Blend::over, Blend::screen});
    sky.layers[2].render.isolate = true;
    sky.layers[3].render.holdout = true;
    sky.expect_same_bits({0, 1, 2, 3, 4});
}

TEST(ByTheBlock, Children) {
    Sky({Blend::over, Blend::screen, Blend::add}, 60.0f, 150).expect_same_bits({0, 1, 2}, 200000);
}

TEST(ByTheBlock, Lenses) {
    for (const Projection projection :
         {Projection::orthographic, Projection::fisheye, Projection::equirectangular}) {
        SCOPED_TRACE(int(projection));
        Sky sky({Blend::over, Blend::screen}, 60.0f, 200);
        sky.camera.projection = projection;
        sky.camera.focal_px =
            projection == Projection::orthographic ? 12.0 : block_wide / (2.0 * 3.14159265358979);
        if (projection != Projection::orthographic) sky.camera.eye = {0.3, 0.2, 0.1};  // among them
        sky.expect_same_bits({0, 1}, 200000);
    }
}

TEST(ByTheBlock, FromWithin) {
    Sky sky({Blend::over, Blend::add}, 40.0f, 300);
    sky.camera.eye = {0.3, 0.2, 0.1};
    sky.expect_same_bits({0, 1}, 200000);
}

TEST(ByTheBlock, AllThatAFrameHas) {
    Sky sky(affine);
    sky.settings.aov_depth = sky.settings.aov_coverage = sky.settings.aov_count = sky.settings.aov_layers =
        true;
    sky.settings.region = {20, 11, 57, 43};
    sky.expect_same_bits({1, 2, 4});
}

TEST(ByTheBlock, WhatDoesNotShowIsNotMade) {
    Sky sky({Blend::over});
    sky.camera.focal_px = 500.0;
    for (float& radius : sky.sets[0].radius) radius = 0.01f;
    const std::vector<RenderLayer> some = sky.by_block(10, {0});
    const RenderedFrame whole = render(sky.layers, sky.camera, nullptr, sky.settings);
    const RenderedFrame frame = render(some, sky.camera, nullptr, sky.settings);
    EXPECT_EQ(whole.beauty.pixels, frame.beauty.pixels);
    EXPECT_GT(sky.made(), 5);
    EXPECT_LT(sky.made(), 100);  // of 150
}

TEST(ByTheBlock, TheStoreKeepsToItsLimit) {
    SplatStore store;
    store.limit(1000);
    store.take<char>(500);
    EXPECT_EQ(store.used_bytes(), 512);  // whole cache lines
    EXPECT_THROW(store.take<char>(500), StoreFull);
    store.clear();
    EXPECT_NO_THROW(store.take<char>(900));
    store.limit(0);
    EXPECT_NO_THROW(store.take<char>(5000));
}

TEST(ByTheBlock, LittleMemoryTakesMorePasses) {
    Sky sky({Blend::over});
    const auto passes = [&](std::int64_t limit) {
        const std::vector<RenderLayer> some = sky.by_block(50, {0});
        sky.settings.memory_limit_bytes = limit;
        render(some, sky.camera, nullptr, sky.settings);
        return sky.made();
    };
    const int one = passes(0);
    EXPECT_EQ(passes(std::int64_t{1} << 30), one);
    EXPECT_GT(passes(70000), one);
}

TEST(ByTheBlock, WhatWillNotFitIsSaid) {
    std::vector<OneSplat> splats(20000);
    for (OneSplat& s : splats) s.position = {0.0f, 0.0f, 0.0f};
    Sky sky({Blend::over});
    sky.sets[0] = make_splats(splats);
    const std::vector<RenderLayer> some = sky.by_block(1000, {0});
    sky.settings.memory_limit_bytes = 100000;
    EXPECT_HAS(ERROR_OF(render(some, sky.camera, nullptr, sky.settings)), "splats at one distance");
}

/// Draws some groups, wrongly, before it is lost.
class LostDevice final : public RenderDevice {
  public:
    LostDevice(std::size_t groups, bool throws) : groups_(groups), throws_(throws) {}
    std::string name() const override { return "lost"; }
    std::string cannot(const FrameJob&) const override { return {}; }
    std::optional<GroupPlanes> draw(const FrameJob& job, std::size_t group, bool) override {
        ++asked;
        if (group >= groups_ && throws_) throw std::bad_alloc();
        if (group >= groups_) return {};
        GroupPlanes planes;
        planes.light = planes.through = planes.more =
            make_image(job.region.width, job.region.height, 4, 0.7f);
        planes.splats = 1000;
        return planes;
    }
    int asked = 0;

  private:
    std::size_t groups_;
    bool throws_;  // where this machine's memory does not suffice
};

TEST(Device, TheProcessorFinishesWhatALostOneHasBegun) {
    int lost_later = 0;
    for (std::uint32_t seed = 1; seed <= 12; ++seed) {
        RandomScene scene(seed, 200);
        scene.settings.aov_depth = scene.settings.aov_coverage = scene.settings.aov_count = true;
        for (RenderLayer& layer : scene.layers) layer.render.isolate = true;
        const RenderedFrame expected = render(scene.layers, scene.camera, nullptr, scene.settings);
        for (const std::size_t drawn : {0, 1, 2}) {
            if (drawn >= scene.layers.size()) continue;
            LostDevice device(drawn, seed % 3 == 0);
            scene.settings.device = &device;
            const RenderedFrame frame = render(scene.layers, scene.camera, nullptr, scene.settings);
            scene.settings.device = nullptr;
            EXPECT_EQ(device.asked, int(drawn) + 1) << "not again once it is lost";
            lost_later += drawn > 0;
            EXPECT_EQ(frame.beauty.pixels, expected.beauty.pixels) << seed;
            EXPECT_EQ(frame.depth.pixels, expected.depth.pixels) << seed;
            EXPECT_EQ(frame.count.pixels, expected.count.pixels) << seed;
            EXPECT_EQ(frame.statistics.splats_drawn, expected.statistics.splats_drawn);
            EXPECT_EQ(frame.statistics.device, "");
            EXPECT_EQ(frame.statistics.not_on_device, "it ran out of memory or was lost");
        }
    }
    EXPECT_GT(lost_later, 5);
}

}  // namespace
}  // namespace astrosplat::test
