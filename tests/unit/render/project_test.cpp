// Projection of splats, their bins and memory; tiles, the order of their work, and who watches them.
#include "render/project.h"

#include "render/bin_rects.h"
#include "render/fold.h"
#include "render/screen_splat.h"
#include "splats/splat_set.h"
#include "support/printing.h"
#include "support/test.h"
#include "unit/render/scenes.h"

namespace astrosplat {
namespace {

// Projection: place, size, near fade and sort depth of single splats and of whole vectors of them.

using namespace astrosplat::test;

constexpr ScreenRect everywhere{-1e6f, -1e6f, 1e6f, 1e6f};

Buffer<ScreenSplat> project_all(const ShadedSplats& splats, const Camera& camera) {
    const RenderLayer layer = layer_of("one", splats);
    Buffer<ScreenSplat> out;
    Buffer<Shape> shapes;
    project(make_projection(layer, 0, camera, settings_of(64, 64)), 0, splats.size(), everywhere, out,
            shapes);
    EXPECT_TRUE(shapes.empty());
    return out;
}

/// Enough copies for whole vectors and for what is left over.
ShadedSplats copies(const OneSplat& splat) { return make_splats(std::vector<OneSplat>(19, splat)); }

Camera perspective_camera() {
    Camera camera;
    camera.focal_px = 100.0;
    camera.center_x_px = camera.center_y_px = 32.0;
    camera.near = 1.0;
    return camera;
}

TEST(Project, PerspectiveDividesByDepth) {
    const Buffer<ScreenSplat> found = project_all(copies({{1.0f, 2.0f, -10.0f}, 0.5f}), perspective_camera());
    ASSERT_EQ(found.size(), 19u);
    for (const ScreenSplat& splat : found) {
        EXPECT_EQ(splat.x_px, 42.0f);
        EXPECT_EQ(splat.y_px, 12.0f);  // y down
        EXPECT_EQ(splat.radius_px, 5.0f);
        EXPECT_EQ(std::bit_cast<float>(splat.depth), 1.0f + 4.0f + 100.0f);  // distance squared
    }
}

TEST(Project, OrthographicKeepsSizesAndSortsByDepth) {
    const Buffer<ScreenSplat> found = project_all(copies({{1.0f, 2.0f, -10.0f}, 0.5f}), pixel_camera(64, 64));
    ASSERT_EQ(found.size(), 19u);
    for (const ScreenSplat& splat : found) {
        EXPECT_EQ(splat.x_px, 33.0f);
        EXPECT_EQ(splat.y_px, 30.0f);
        EXPECT_EQ(splat.radius_px, 0.5f);
        EXPECT_EQ(std::bit_cast<float>(splat.depth), 1010.0f);
    }
}

TEST(Project, NearFadeIsTheCamerasOrOneRadius) {
    Camera camera = perspective_camera();
    const ShadedSplats splats = copies({{0.0f, 0.0f, -2.0f}, 0.5f});  // one unit behind the near plane
    const auto opacity = [&](double near_fade) {
        camera.near_fade = near_fade;
        const Buffer<ScreenSplat> found = project_all(splats, camera);
        EXPECT_EQ(found.size(), 19u);
        for (const ScreenSplat& splat : found) EXPECT_EQ(splat.opacity, found.front().opacity);
        return found.front().opacity;
    };
    EXPECT_EQ(opacity(0.0), 1.0f);      // farther than its radius
    EXPECT_EQ(opacity(2.0), 0.5f);      // half way
    EXPECT_EQ(opacity(4.0), 0.15625f);  // smoothstep of a quarter
    const ShadedSplats wide = copies({{0.0f, 0.0f, -2.0f}, 2.0f});
    camera.near_fade = 0.25;
    EXPECT_EQ(project_all(wide, camera).front().opacity, 0.5f);  // its radius, which is larger
}

TEST(Project, TheLimitOfLevelsIsForTheLinesOfThePicture) {
    const ShadedSplats splats = copies({{0.0f, 0.0f, -2.0f}, 0.5f});
    RenderLayer layer = layer_of("one", splats);
    layer.render.lod.max_px = 90.0f;
    const auto limit = [&](std::int64_t height) {
        return make_projection(layer, 0, perspective_camera(), settings_of(64, height)).lod_limit_px;
    };
    EXPECT_EQ(limit(1080), 90.0f);
    EXPECT_EQ(limit(540), 45.0f);
    layer.render.blend = Blend::lighten;  // never split
    EXPECT_EQ(limit(1080), 0.0f);
}

// A million children of one splat are no reason to keep somebody waiting.
TEST(Project, StopsAmongTheChildrenOfASplat) {
    const ShadedSplats splats = make_splats({{{0.0f, 0.0f, -2.0f}, 0.5f}});
    RenderLayer layer = layer_of("one", splats);
    layer.render.falloff.shape = Falloff::Shape::gaussian;
    layer.render.lod.max_px = 0.01f;
    layer.render.lod.max_children = 1 << 20;
    LodTable table(layer.render.falloff);
    table.prepare(10);
    std::atomic<bool> cancelled{false};
    LayerProjection projection = make_projection(layer, 0, perspective_camera(), settings_of(64, 64));
    projection.lod = &table;
    projection.cancelled = &cancelled;
    Buffer<ScreenSplat> out;
    Buffer<Shape> shapes;
    project(projection, 0, 1, everywhere, out, shapes);
    EXPECT_EQ(out.size(), std::size_t{1} << 20);
    out.clear();
    cancelled = true;
    EXPECT_THROW(project(projection, 0, 1, everywhere, out, shapes), Cancelled);
    EXPECT_LT(out.size(), 5000u);
}

TEST(Project, NothingOutsideNearAndFar) {
    Camera camera = perspective_camera();
    EXPECT_EQ(project_all(copies({{0.0f, 0.0f, -1.0f}, 0.5f}), camera).size(), 0u);
    EXPECT_EQ(project_all(copies({{0.0f, 0.0f, -1e6f}, 0.5f}), camera).size(), 19u);
    camera.far = 20.0;
    EXPECT_EQ(project_all(copies({{0.0f, 0.0f, -20.0f}, 0.5f}), camera).size(), 19u);
    EXPECT_EQ(project_all(copies({{0.0f, 0.0f, -20.5f}, 0.5f}), camera).size(), 0u);
}

/// Of all sizes, in front of the camera and behind it, on the frame and outside it; every fifth a star.
ShadedSplats mixed_splats() {
    std::vector<OneSplat> splats;
    for (int i = 0; i < 4000; ++i) {
        const auto part = [&](int n) { return float(i * n % 3989) / 3989.0f; };
        const float size = part(1117) * part(1117) * part(1117);
        splats.push_back({{12.0f * part(727) - 6.0f, 12.0f * part(1931) - 6.0f, 4.0f - 12.0f * part(2953)},
                          0.01f + 1.5f * size,
                          0.1f + 0.8f * part(331),
                          {1.0f, part(557), 0.5f}});
    }
    ShadedSplats set = make_splats(splats);
    for (std::size_t i = 0; i < set.id.size(); i += 5) set.id[i] |= star_band << 48;
    return set;
}

bool is_before(const ScreenSplat& a, const ScreenSplat& b) { return in_front_of(a, b); }

/// A row alone is no vector.
TEST(Project, VectorsDivideWhatSingleSplatsDo) {
    const ShadedSplats splats = mixed_splats();
    const LodTable table = [] {
        LodTable made({Falloff::Shape::gaussian});
        made.prepare(4);
        return made;
    }();
    for (const float noise : {0.0f, 0.5f})
        for (const float star_distance : {0.0f, 5.0f}) {
            RenderLayer asked = layer_of("mixed", splats, Blend::over, Falloff::Shape::gaussian);
            asked.render.lod = {100.0f, 256, noise};
            asked.render.lod.star_distance = star_distance;
            LayerProjection layer = make_projection(asked, 0, perspective_camera(), settings_of(64, 64));
            layer.lod = &table;
            const ScreenRect rect{0.0f, 0.0f, 64.0f, 64.0f};
            Buffer<ScreenSplat> together, single;
            Buffer<Shape> shapes;
            project(layer, 0, splats.size(), rect, together, shapes);
            for (std::int64_t i = 0; i < splats.size(); ++i) project(layer, i, i + 1, rect, single, shapes);
            std::ranges::sort(together, is_before);
            std::ranges::sort(single, is_before);
            ASSERT_EQ(together.size(), single.size());
            EXPECT_GT(single.size(), 5000u) << "children";
            EXPECT_EQ(std::memcmp(together.data(), single.data(), single.size() * sizeof(ScreenSplat)), 0)
                << noise << " " << star_distance;
        }
}

// Which bins of a pyramid discs touch, against a plain count.

constexpr float tile_px = 32.0f, x0_px = 100.0f, y0_px = -40.0f;

/// Bins of 32, 64, 128 and 256 px over 256 x 128 px.
std::vector<BinLevel> four_levels() { return {{0, 8, 7, 3}, {32, 4, 3, 1}, {40, 2, 1, 0}, {42, 1, 0, 0}}; }

struct Disc {
    float x_px, y_px, reach_px;
};

/// The rectangle that the header asks for, in the plainest way.
BinRect expected(const std::vector<BinLevel>& levels, const Disc& disc) {
    std::size_t l = 0;
    float bin_px = tile_px;
    while (disc.reach_px > bin_px && l + 1 < levels.size()) bin_px *= 2.0f, ++l;
    const auto bin = [&](float px, float last) {
        return std::uint32_t(std::clamp(std::floor(px / bin_px), 0.0f, last));
    };
    const BinLevel& level = levels[l];
    const float x = disc.x_px - x0_px, y = disc.y_px - y0_px;
    const std::uint32_t left = bin(x - disc.reach_px, level.last_column),
                        right = bin(x + disc.reach_px, level.last_column),
                        top = bin(y - disc.reach_px, level.last_row),
                        bottom = bin(y + disc.reach_px, level.last_row);
    return {level.first_bin + top * level.columns + left, level.columns, right - left + 1, bottom - top + 1};
}

std::vector<Disc> many_discs() {
    std::vector<Disc> discs;
    for (int i = 0; i < 1003; ++i) {  // no whole number of vectors
        const float reach_px = 0.5f * std::ldexp(1.0f, i % 11);
        discs.push_back(
            {x0_px + float(i * 37 % 300) - 20.25f, y0_px + float(i * 53 % 170) - 20.5f, reach_px});
    }
    discs.push_back({x0_px + 64.0f, y0_px + 64.0f, 32.0f});  // on the edges of bins
    discs.push_back({1e30f, -1e30f, 3.0f});
    discs.push_back({0.0f, 0.0f, 1e30f});
    return discs;
}

TEST(BinRects, AreThoseThatTheSquareTouchesOnTheLevelThatFits) {
    const std::vector<BinLevel> levels = four_levels();
    const std::vector<Disc> all = many_discs();
    Discs discs;
    discs.resize(all.size() + bin_rect_room);
    for (std::size_t i = 0; i < all.size(); ++i) discs.set(i, all[i].x_px, all[i].y_px, all[i].reach_px);
    for (std::size_t i = all.size(); i < all.size() + bin_rect_room; ++i) discs.set(i, NAN, NAN, NAN);
    for (const std::string& target : vector_targets()) {
        SCOPED_TRACE(target);
        set_vector_target(target);
        std::vector<BinRect> rects(all.size() + bin_rect_room);
        find_bins({x0_px, y0_px, tile_px, levels}, discs, all.size(), rects.data());
        for (std::size_t i = 0; i < all.size(); ++i) {
            const BinRect want = expected(levels, all[i]), &found = rects[i];
            ASSERT_EQ(found.first_bin, want.first_bin) << i;
            ASSERT_EQ(found.columns, want.columns) << i;
            ASSERT_EQ(found.wide, want.wide) << i;
            ASSERT_EQ(found.high, want.high) << i;
            ASSERT_LE(found.wide * found.high, most_bins) << i;
        }
    }
    set_vector_target("best");
}

// The memory of projected splats, estimated from a part of them as from all, whatever tiles the part alone
// would choose.

/// Every `step`-th splat of a frame of 640x480 px that is full of small ones and has some wide ones.
ShadedSplats some_splats(int step) {
    constexpr int count = 400000;
    std::vector<OneSplat> all;
    std::uint32_t state = 5;
    const auto next = [&state] {
        state = state * 1664525u + 1013904223u;
        return float(state >> 8) / 16777216.0f;
    };
    for (int i = 0; i < count; ++i) {
        OneSplat splat{
            {640.0f * next() - 320.0f, 480.0f * next() - 240.0f, next()}, 1.0f + 2.0f * next(), 0.1f};
        if (i % 400 == 0) splat.radius = 60.0f;
        if (i % step == 0 || (i % 400 == 0 && (i / 400) % step == 0)) all.push_back(splat);
    }
    return make_splats(all);
}

std::int64_t bytes_of(const ShadedSplats& splats, double each, int tile = 0, float max_px = 0.0f) {
    RenderLayer layer = layer_of("a", splats);
    layer.render.lod.max_px = max_px;
    RenderSettings settings = settings_of(640, 480);
    settings.splats_each = each;
    settings.tile_px = tile;
    RenderCache cache;
    return scattered_bytes({&layer, 1}, pixel_camera(640, 480), settings, cache);
}

TEST(ScatteredBytes, APartTellsWhatAllTake) {
    const ShadedSplats all = some_splats(1), part = some_splats(9);
    const double each = double(all.size()) / double(part.size());
    for (const float max_px : {0.0f, 40.0f}) {
        const auto whole = double(bytes_of(all, 1.0, 0, max_px));
        EXPECT_NEAR(double(bytes_of(part, each, 0, max_px)), whole, 0.04 * whole);
        EXPECT_GT(whole, double(all.size()) * sizeof(ScreenSplat));
    }
}

// Few splats would choose the wider ones.
TEST(ScatteredBytes, TilesAreThoseOfAllSplats) {
    const ShadedSplats part = some_splats(9);
    EXPECT_EQ(bytes_of(part, 1.0), bytes_of(part, 1.0, 64));
    EXPECT_EQ(bytes_of(part, 1000.0), bytes_of(part, 1000.0, 32));
    EXPECT_GT(bytes_of(part, 1000.0), 1000 * bytes_of(part, 1.0));
}

// The sort and the fold of a single tile: the total order, and stopping in the middle of the work.

/// Splats whose depths repeat, in runs that are not in order.
std::vector<ScreenSplat> shuffled_splats(std::uint32_t count) {
    std::vector<ScreenSplat> splats;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t n = i * 7919u % count;
        ScreenSplat s{16.0f, 16.0f, 5.0f, 0.01f, {1.0f, 1.0f, 1.0f}, 0, n, 0, 0};
        s.depth = std::bit_cast<std::uint32_t>(float(n % 97u) + 1.0f);
        splats.push_back(s);
    }
    return splats;
}

TEST(SplatSorter, GivesTheTotalOrderAcrossRuns) {
    const std::vector<ScreenSplat> splats = shuffled_splats(1000);
    const std::span<const ScreenSplat> all(splats);
    const std::vector<std::span<const ScreenSplat>> runs = {
        all.subspan(600), all.first(250), {}, all.subspan(250, 350)};
    SplatSorter sorter;
    const std::span<const ScreenSplat* const> order = sorter.sort(runs, {});
    ASSERT_EQ(order.size(), splats.size());
    for (std::size_t i = 0; i + 1 < order.size(); ++i) EXPECT_TRUE(in_front_of(*order[i], *order[i + 1]));
}

TEST(Cancelling, StopsTheSortAndTheFold) {
    const std::vector<ScreenSplat> splats = shuffled_splats(1000);
    const std::vector<std::span<const ScreenSplat>> runs = {splats};
    SplatSorter sorter;
    const std::span<const ScreenSplat* const> order = sorter.sort(runs, {});
    const FootprintTable table = make_footprint_table({}, 0.5f);
    const FoldLayer layer{&table, Blend::over, false};
    FoldSettings settings;
    settings.kind = FoldKind::over;
    TilePlanes planes;
    planes.reset({0, 0, 32, 32}, settings, 1);
    const std::atomic<bool> cancelled = true;
    const Progress progress{{}, &cancelled};
    EXPECT_THROW(fold({order, {&layer, 1}, settings, progress}, planes), Cancelled);
    SplatSorter stopped;
    EXPECT_THROW(stopped.sort(runs, progress), Cancelled);
    EXPECT_THROW(make_footprint_table({}, 0.5f, progress), Cancelled);
    fold({order, {&layer, 1}, settings, {}}, planes);
    EXPECT_GT(planes.color[0][planes.at(16, 16)], 0.9f);
}

/// One splat of each radius, far from the others.
std::vector<ScreenSplat> splats_of(std::span<const float> radii_px) {
    std::vector<ScreenSplat> splats;
    for (std::size_t i = 0; i < radii_px.size(); ++i) {
        const float x = 8.0f + 16.0f * float(i % 8), y = 8.0f + 16.0f * float(i / 8);
        ScreenSplat s{
            x + 3.0f / 256.0f, y - 9.0f / 256.0f, radii_px[i], 0.5f, {1.0f, 0.5f, 0.25f}, 0, 0, 0, 0};
        s.depth = std::bit_cast<std::uint32_t>(1.0f + float(i));
        splats.push_back(s);
    }
    return splats;
}

/// Radii around the ends of the table of footprints, on its nodes and between them.
std::vector<float> telling_radii() {
    const float least = shared::SMALLEST_RADIUS_PX, most = 1024.0f;
    return {0.0f,
            1e-30f,
            0.001f,
            std::nextafter(least, 0.0f),
            least,
            std::nextafter(least, 1.0f),
            1.0f,
            2.5f,
            4.0f + 4.0f / 32.0f,
            6.7f,
            most * 31.0f / 32.0f,
            std::nextafter(most, 0.0f),
            most,
            std::nextafter(most, 2000.0f),
            1030.0f,
            1e6f,
            1e30f};
}

class FootprintsOfAVector : public testing::TestWithParam<Falloff::Shape> {};

TEST_P(FootprintsOfAVector, AreThoseOfOneSplatAfterTheOther) {
    Falloff falloff;
    falloff.shape = GetParam();
    Falloff other;
    other.shape = GetParam() == Falloff::Shape::gaussian ? Falloff::Shape::linear : Falloff::Shape::gaussian;
    const FootprintTable table = make_footprint_table(falloff, 0.5f),
                         unused = make_footprint_table(other, 0.5f);
    // A second layer with another table makes the fold look at every splat by itself.
    const FoldLayer layers[] = {{&table, Blend::screen, false}, {&unused, Blend::screen, false}};
    const std::vector<float> radii = telling_radii();
    for (const std::string& target : vector_targets()) {
        SCOPED_TRACE(target);
        set_vector_target(target);
        for (const float radius_px : radii) {  // one by one: large ones cover all others
            const std::vector<ScreenSplat> splats = splats_of(std::vector<float>(5, radius_px));
            std::vector<const ScreenSplat*> order;
            for (const ScreenSplat& splat : splats) order.push_back(&splat);
            TilePlanes together, single;
            for (TilePlanes* planes : {&together, &single}) planes->reset({0, 0, 128, 32}, {}, 2);
            fold({order, {layers, 1}, {}, {}}, together);
            fold({order, {layers, 2}, {}, {}}, single);
            for (int k = 0; k < 3; ++k) EXPECT_EQ(together.color[k], single.color[k]) << radius_px;
            for (int k = 0; k < 4; ++k)
                EXPECT_EQ(together.transmittance[k], single.transmittance[k]) << radius_px;
            EXPECT_EQ(together.alpha, single.alpha) << radius_px;
        }
    }
    set_vector_target("best");
}

INSTANTIATE_TEST_SUITE_P(Shapes, FootprintsOfAVector, testing::ValuesIn(all_shapes));

// Who watches a frame being rendered sees every pixel once, the middle first, and can stop it at any tile.

constexpr int frame_width_px = 211, frame_height_px = 133;

/// A row of splats so dense that a small memory limit asks for bands.
ShadedSplats dense_splats() {
    std::vector<OneSplat> splats;
    for (int i = 0; i < 4000; ++i) {
        const auto x = float(i % 100), y = float(i / 100);
        splats.push_back({{2.0f * x - 100.0f, 3.0f * y - 60.0f, 0.1f * x}, 3.0f, 0.5f, {1.0f, 0.5f, 0.25f}});
    }
    return make_splats(splats);
}

/// A rendering of dense_splats, watched by `tile_done`.
RenderedFrame watch(const RenderSettings& settings, const TileDone& tile_done,
                    const Progress& progress = {}) {
    const ShadedSplats splats = dense_splats();
    const RenderLayer layer = layer_of("dense", splats);
    return render({&layer, 1}, pixel_camera(frame_width_px, frame_height_px), nullptr, settings, progress,
                  nullptr, tile_done);
}

class TileDoneTest : public ::testing::TestWithParam<std::int64_t> {  // memory limit in bytes
  protected:
    RenderSettings settings() const {
        RenderSettings s = settings_of(frame_width_px, frame_height_px);
        s.region = {10, 5, 150, 120};
        s.memory_limit_bytes = GetParam();
        return s;
    }
};

TEST_P(TileDoneTest, ReportsEachPixelOnceAndFinal) {
    const Region region = settings().region;
    Image reported = make_image(region.width, region.height, 4);
    std::vector<int> times(std::size_t(region.width * region.height), 0);
    std::mutex mutex;
    const RenderedFrame frame = watch(settings(), [&](const Region& tile, const RenderedFrame& so_far) {
        const std::lock_guard lock(mutex);
        for (std::int64_t y = tile.y - region.y; y < tile.y - region.y + tile.height; ++y)
            for (std::int64_t x = tile.x - region.x; x < tile.x - region.x + tile.width; ++x) {
                ++times[std::size_t(y * region.width + x)];
                for (int k = 0; k < 4; ++k) reported.at(x, y)[k] = so_far.beauty.at(x, y)[k];
            }
    });
    EXPECT_EQ(times, std::vector<int>(times.size(), 1));
    EXPECT_EQ(reported.pixels, frame.beauty.pixels);
    EXPECT_EQ(frame.beauty.pixels, watch(settings(), {}).beauty.pixels);
}

TEST_P(TileDoneTest, StopsWhenCancelledFromATile) {
    std::atomic<bool> cancelled = false;
    std::atomic<int> tiles = 0;
    const Progress progress{{}, &cancelled};
    EXPECT_THROW(watch(
                     settings(),
                     [&](const Region&, const RenderedFrame&) {
                         if (++tiles == 3) cancelled = true;
                     },
                     progress),
                 Cancelled);
    EXPECT_LT(tiles, 3 + thread_count());
}

INSTANTIATE_TEST_SUITE_P(WholeAndInBands, TileDoneTest, ::testing::Values(0, 100000));

TEST(TileDone, TheMiddleComesFirst) {
    const int before = thread_count();
    set_thread_count(1);
    std::vector<std::int64_t> distances;  // of the tiles' centres from the picture's, squared and times four
    RenderSettings settings = settings_of(frame_width_px, frame_height_px);
    settings.tile_px = 32;
    watch(settings, [&](const Region& t, const RenderedFrame&) {
        const std::int64_t x = 2 * t.x + t.width - frame_width_px, y = 2 * t.y + t.height - frame_height_px;
        distances.push_back(x * x + y * y);
    });
    set_thread_count(before);
    EXPECT_EQ(distances.size(), 7u * 5u);
    EXPECT_TRUE(std::is_sorted(distances.begin(), distances.end()));
}

/// Its first tiles do not wait for splats far from them, and later ones use their memory again.
TEST(TileDone, ManySplatsComeInBandsFromTheMiddle) {
    constexpr int wide_px = 128, high_px = 256, rows = high_px / 32;
    std::vector<OneSplat> splats(2'000'000);
    for (std::size_t i = 0; i < splats.size(); ++i) {
        const auto x = float(i % 2000), y = float(i / 2000);
        splats[i] = {{0.064f * x - 64.0f, 0.256f * y - 128.0f, 0.01f * x}, 0.3f, 0.01f, {1.0f, 0.5f, 0.25f}};
    }
    const ShadedSplats set = make_splats(splats);
    const RenderLayer layer = layer_of("many", set);
    RenderSettings settings = settings_of(wide_px, high_px);
    settings.tile_px = 32;
    const int before = thread_count();
    set_thread_count(1);
    std::vector<std::int64_t> order;  // rows of tiles, as they come
    const auto picture = [&](const TileDone& tile_done) {
        return render({&layer, 1}, pixel_camera(wide_px, high_px), nullptr, settings, {}, nullptr, tile_done);
    };
    const RenderedFrame watched =
        picture([&](const Region& t, const RenderedFrame&) { order.push_back(t.y / settings.tile_px); });
    const RenderedFrame whole = picture({});
    set_thread_count(before);
    const std::size_t columns = wide_px / 32;
    EXPECT_EQ(order.size(), columns * rows);
    for (std::size_t i = 0; i < columns; ++i) EXPECT_EQ(order[i], order[0]) << "a band of one row";
    EXPECT_NEAR(double(order[0]), 0.5 * (rows - 1), 0.5);
    EXPECT_EQ(watched.beauty.pixels, whole.beauty.pixels);
    EXPECT_EQ(watched.statistics.splats_drawn, whole.statistics.splats_drawn);
}

}  // namespace
}  // namespace astrosplat
