// The preview's picture against the offline renderer's, and the order it blends in.
#include "gl/preview.h"
#include "camera/camera.h"
#include "core/rotation.h"
#include "gl/gl_fixture.h"
#include "gl/picture_scenes.h"
#include "gl/splat_buffers.h"
#include "merge/cut.h"
#include "support/test.h"
#include "unit/render/scenes.h"

namespace astrosplat {
namespace {

using test::GlTest;

constexpr int width = 320, height = 200;

class PreviewPicture : public GlTest {
  protected:
    /// One preview for many pictures, whose programs and tables stay.
    static GlPreview& shared_preview() {
        static GlPreview preview;
        return preview;
    }

    static Image draw_with(GlPreview& preview, const std::vector<PreviewLayer>& layers, const Camera& camera,
                           const Environment* environment = nullptr) {
        preview.draw(layers, {camera, environment, width, height});
        preview.wait_for_order();
        preview.draw(layers, {camera, environment, width, height});
        EXPECT_FALSE(preview.sorting());
        return preview.read();
    }

    static Image draw(const std::vector<PreviewLayer>& layers, const Camera& camera,
                      const Environment* environment = nullptr) {
        return draw_with(shared_preview(), layers, camera, environment);
    }

    void expect_like_offline(const std::vector<PreviewLayer>& layers, const Camera& camera,
                             const Environment* environment = nullptr) {
        const Image offline = test::offline(layers, camera, environment, width, height);
        const test::Likeness likeness = test::compare_shown(draw(layers, camera, environment), offline);
        EXPECT_GE(likeness.psnr_db, 45.0);
        EXPECT_LE(likeness.difference_999, 1.0 / 255.0);
        EXPECT_NEAR(likeness.brightness, 1.0, 2e-3);
    }
    /// By the perspective camera.
    void expect_like_offline(const std::vector<PreviewLayer>& layers,
                             const Environment* environment = nullptr) {
        expect_like_offline(layers, test::perspective_camera(width, height), environment);
    }
};

LayerRender render_with(Falloff::Shape shape, Blend blend = Blend::over) {
    LayerRender render;
    render.falloff.shape = shape;
    render.blend = blend;
    return render;
}

TEST_F(PreviewPicture, EveryFalloff) {
    for (const auto shape : test::all_shapes) {
        SCOPED_TRACE(int(shape));
        for (float radius : {0.002f, 0.03f, 0.15f})
            expect_like_offline({test::cloud_layer(3000, 5, radius, render_with(shape))});
    }
}

TEST_F(PreviewPicture, SharpFalloffsAndCores) {
    LayerRender sharp = render_with(Falloff::Shape::exponential),
                spike = render_with(Falloff::Shape::gaussian);
    sharp.falloff.sharpness = 20.0f;
    spike.falloff.sharpness = 30.0f;
    LayerRender core = render_with(Falloff::Shape::trapezoid);
    core.falloff.core = 0.9f;
    expect_like_offline({test::cloud_layer(1500, 9, 0.1f, sharp), test::cloud_layer(1500, 5, 0.1f, spike),
                         test::cloud_layer(1500, 4, 0.1f, core)});
}

TEST_F(PreviewPicture, EveryBlendMergedAndIsolated) {
    for (const auto blend :
         {Blend::over, Blend::add, Blend::screen, Blend::lighten, Blend::hybrid, Blend::absorb}) {
        for (bool isolate : {false, true}) {
            SCOPED_TRACE(int(blend));
            LayerRender render = render_with(Falloff::Shape::gaussian, blend);
            render.isolate = isolate;
            render.opacity = 0.8f;
            const std::vector<PreviewLayer> layers = {
                test::cloud_layer(1500, 9, 0.06f, render_with(Falloff::Shape::linear)),
                test::cloud_layer(1500, 5, 0.06f, render),
                test::cloud_layer(500, 7, 0.1f, render_with(Falloff::Shape::constant))};
            expect_like_offline(layers);
        }
    }
}

TEST_F(PreviewPicture, DustAmongLight) {
    for (const auto blend : {Blend::over, Blend::add}) {
        PreviewLayer dusty = test::cloud_layer(2000, 5, 0.06f, render_with(Falloff::Shape::gaussian, blend));
        auto set = std::make_shared<SplatSet>(*dusty.set);
        for (std::size_t i = 0; i < set->color.size(); i += 2) set->color[i] = {-0.5f, -1.0f, -2.0f};
        set->absorbs = true;
        dusty.set = set;
        dusty.layer.absorbs = true;
        expect_like_offline({dusty});
    }
}

TEST_F(PreviewPicture, LightAboveOneUnderScreen) {
    PreviewLayer bright =
        test::cloud_layer(1500, 5, 0.06f, render_with(Falloff::Shape::gaussian, Blend::screen));
    bright.look.grade.gain = 5.0f;
    expect_like_offline({test::cloud_layer(1500, 9, 0.06f, render_with(Falloff::Shape::linear)), bright});
    bright.layer.render.isolate = true;
    expect_like_offline({test::cloud_layer(1500, 9, 0.06f, render_with(Falloff::Shape::linear)), bright});
}

TEST_F(PreviewPicture, HoldoutsMergedAndIsolatedWithAndWithoutEnvironment) {
    const Environment sky = test::small_sky(1);
    for (bool isolate : {false, true}) {
        LayerRender holds = render_with(Falloff::Shape::gaussian);
        holds.holdout = true;
        holds.isolate = isolate;
        const std::vector<PreviewLayer> layers = {
            test::cloud_layer(1500, 9, 0.06f, render_with(Falloff::Shape::linear)),
            test::cloud_layer(1500, 5, 0.08f, holds)};
        expect_like_offline(layers);
        expect_like_offline(layers, &sky);
    }
}

TEST_F(PreviewPicture, EnvironmentsOfOneAndOfSixFaces) {
    for (int faces : {1, 6}) {
        const Environment sky = test::small_sky(faces);
        expect_like_offline({}, &sky);
        expect_like_offline({test::cloud_layer(800, 5, 0.08f, render_with(Falloff::Shape::gaussian))},
                            test::orthographic_camera(width, height), &sky);
        expect_like_offline(
            {test::cloud_layer(800, 5, 0.08f, render_with(Falloff::Shape::gaussian, Blend::add))}, &sky);
    }
}

TEST_F(PreviewPicture, Orthographic) {
    expect_like_offline(
        {test::cloud_layer(2000, 9, 0.06f, render_with(Falloff::Shape::gaussian)),
         test::cloud_layer(1000, 5, 0.06f, render_with(Falloff::Shape::linear, Blend::hybrid))},
        test::orthographic_camera(width, height));
}

TEST_F(PreviewPicture, LayersPlacedFarFromTheOrigin) {
    PreviewLayer layer = test::cloud_layer(2000, 9, 0.06f, render_with(Falloff::Shape::gaussian));
    layer.layer.scale = 0.5;
    layer.layer.world_from_layer = rotation_from_degrees({20.0, 50.0, -10.0});
    layer.layer.translate = {1e5, -2e5, 3e5};
    Camera camera = test::perspective_camera(width, height);
    camera.eye = camera.eye + layer.layer.translate;
    expect_like_offline({layer}, camera);
}

TEST_F(PreviewPicture, FromInsideWithSplatsWiderThanPoints) {
    Camera camera = test::perspective_camera(width, height);
    camera.eye = {0.1, 0.02, 0.3};
    camera.near_fade = 0.05;
    for (const auto blend : {Blend::over, Blend::add, Blend::lighten})
        expect_like_offline({test::cloud_layer(2000, 9, 0.3f, render_with(Falloff::Shape::gaussian, blend))},
                            camera);
}

TEST_F(PreviewPicture, FromInsideWhereverTheSetLies) {
    Camera camera = test::perspective_camera(width, height);
    PreviewLayer layer = test::cloud_layer(2000, 9, 0.3f, render_with(Falloff::Shape::gaussian));
    SplatSet moved = *layer.set;
    for (glm::vec3& p : moved.position) p += glm::vec3(20.0f, -30.0f, 40.0f);
    layer.set = std::make_shared<const SplatSet>(moved);
    camera.eye = {20.1, -29.98, 40.3};
    camera.near_fade = 0.05;
    expect_like_offline({layer}, camera);
}

/// Above the flat cloud, looking down on it.
Camera camera_above(double eye_height) {
    CameraParams params;
    params.position = glm::dvec3(0.0, eye_height, 0.0);
    params.fov = 50.0;
    return make_camera(params, width, height, {});
}

/// Splats that the look moves up to the camera are drawn whole, though the set itself lies far enough away
/// for points.
TEST_F(PreviewPicture, JitterBringsSplatsTooNearForPoints) {
    PreviewLayer layer = test::cloud_layer(600, 9, 0.2f, render_with(Falloff::Shape::linear, Blend::add));
    layer.layer.render.lod.max_px = 0.0f;
    layer.look.alpha.gain = 0.1f;
    layer.look.noise = {Noise{}};
    layer.look.noise[0].frequency = 4.0f;
    layer.look.noise[0].jitter = 8.0f;
    expect_like_offline({layer}, camera_above(1.15));
}

/// The splats of cuts through layers, whose looks the processor applies.
class CutLayers {
  public:
    /// `budget` in all; gives the layers their splats.
    CutLayers(std::vector<PreviewLayer>& layers, const Camera& camera, std::int64_t budget) {
        RenderSettings picture;
        picture.width = width;
        picture.height = height;
        for (const PreviewLayer& layer : layers) {
            const auto tree = std::make_shared<const MergeTree>(build_merge_tree(*layer.set));
            merged_.push_back(
                merge_splats({layer.set, tree, 1.0f}, apply_look(*layer.set, layer.look, layer.inputs)));
            merging_.emplace_back(layer.layer.render);
        }
        std::vector<CutLayer> seen;
        for (std::size_t l = 0; l < layers.size(); ++l)
            seen.push_back({&merged_[l], &merging_[l],
                            make_projection(layers[l].layer, std::uint16_t(l), camera, picture)});
        splats_ = cut_splats(seen, {budget, 0.0f, width, height});
        for (std::size_t l = 0; l < layers.size(); ++l) {
            layers[l].layer.splats = &splats_[l];
            layers[l].layer.render.opacity = 1.0f;
            layers[l].layer.render.lod.max_px = 0.0f;
        }
    }

  private:
    std::vector<MergedSplats> merged_;
    std::vector<MergeSettings> merging_;
    std::vector<ShadedSplats> splats_;
};

TEST_F(PreviewPicture, ACutLooksAsTheProcessorDrawsItUnderEveryBlend) {
    const Camera camera = test::perspective_camera(width, height);
    for (const auto blend :
         {Blend::over, Blend::add, Blend::screen, Blend::lighten, Blend::hybrid, Blend::absorb}) {
        SCOPED_TRACE(int(blend));
        LayerRender render = render_with(Falloff::Shape::gaussian, blend);
        render.opacity = 0.8f;
        std::vector<PreviewLayer> layers = {
            test::cloud_layer(20000, 9, 0.02f, render_with(Falloff::Shape::linear)),
            test::cloud_layer(20000, 5, 0.02f, render)};
        const CutLayers cut(layers, camera, 1500);
        expect_like_offline(layers, camera);
    }
}

TEST_F(PreviewPicture, CutsOfTwoCamerasDoNotMix) {
    GlPreview preview;
    Camera camera = test::perspective_camera(width, height);
    for (const double aside : {0.0, 0.3, 0.6}) {
        std::vector<PreviewLayer> layers = {
            test::cloud_layer(20000, 9, 0.02f, render_with(Falloff::Shape::gaussian))};
        camera.eye.x += aside;
        const CutLayers cut(layers, camera, 700);
        preview.draw(layers, {camera, nullptr, width, height});
        const Image wanted = test::offline(layers, camera, nullptr, width, height);
        EXPECT_GE(test::compare_shown(preview.read(), wanted).psnr_db, 45.0) << "in the very frame";
    }
}

TEST_F(PreviewPicture, SplatsOfACutAreTooWideForPoints) {
    std::vector<PreviewLayer> layers = {
        test::cloud_layer(2000, 9, 0.12f, render_with(Falloff::Shape::linear))};
    const Camera camera = camera_above(0.55);
    const CutLayers cut(layers, camera, 20);
    expect_like_offline(layers, camera);
}

TEST_F(PreviewPicture, NothingAndEmptyLayers) {
    expect_like_offline({});
    PreviewLayer empty = test::cloud_layer(0, 9, 0.1f, render_with(Falloff::Shape::gaussian));
    expect_like_offline({empty});
}

TEST_F(PreviewPicture, ChangesOfLookLayersAndCameraAllArrive) {
    GlPreview old;
    std::vector<PreviewLayer> layers = {
        test::cloud_layer(1500, 9, 0.06f, render_with(Falloff::Shape::linear)),
        test::cloud_layer(1500, 5, 0.06f, render_with(Falloff::Shape::gaussian))};
    Camera camera = test::perspective_camera(width, height);
    const auto expect_fresh = [&](const char* what) {
        GlPreview fresh;
        const Image expected = draw_with(fresh, layers, camera);
        EXPECT_GE(test::compare_shown(draw_with(old, layers, camera), expected).psnr_db, 199.0) << what;
    };
    expect_fresh("first");
    layers[1].look.density = 0.4f;
    expect_fresh("density");
    layers[0].look.noise = {Noise{}};
    layers[0].look.noise[0].jitter = 0.3f;
    expect_fresh("jitter");
    camera.eye = {1.5, -0.7, 1.0};
    expect_fresh("camera");
    layers[0].layer.render.falloff.shape = Falloff::Shape::constant;
    expect_fresh("falloff");
    layers[1].layer.render.isolate = true;
    layers[1].layer.render.blend = Blend::screen;
    expect_fresh("isolated");
    std::swap(layers[0], layers[1]);
    expect_fresh("order of layers");
    layers.pop_back();
    expect_fresh("one layer less");
    EXPECT_EQ(old.shown(), 1500);
}

// The order in which the preview blends: farthest first, ties as the offline renderer breaks them.

/// Splats on the z axis at these places, all kept, with ids that fall as indices rise.
OrderJob job_at(const std::vector<float>& zs) {
    auto set = std::make_shared<SplatSet>();
    Buffer<glm::vec4> places;
    for (std::size_t i = 0; i < zs.size(); ++i) {
        places.push_back({0.0f, 0.0f, zs[i], 1.0f});
        set->id.push_back(1000 - i);
    }
    OrderJob job;
    job.places = std::make_shared<const Buffer<glm::vec4>>(places);
    job.layers = {{0, std::int64_t(zs.size()), glm::dmat3(1.0), glm::dvec3(0.0), set}};
    return job;
}

Order sorted(const OrderJob& job) {
    OrderScratch scratch;
    return sort_far_to_near(job, scratch);
}

std::vector<std::uint32_t> order_of(const OrderJob& job) {
    const Order order = sorted(job);
    return {order.splats.begin(), order.splats.end()};
}

using Indices = std::vector<std::uint32_t>;

TEST(PreviewOrder, FarthestFirst) { EXPECT_EQ(order_of(job_at({-2, -5, -3, -1})), (Indices{1, 2, 0, 3})); }

TEST(PreviewOrder, BehindTheEyeCountsByDistanceToo) {
    EXPECT_EQ(order_of(job_at({-2, 5, -3})), (Indices{1, 2, 0}));
    OrderJob job = job_at({-2, 5, -3});
    job.lens.projection = int(Projection::orthographic);  // by depth: what lies behind comes last
    EXPECT_EQ(order_of(job), (Indices{2, 0, 1}));
    job.places = job_at({0, -2, -1}).places;  // one beside the eye
    EXPECT_EQ(order_of(job), (Indices{1, 2, 0}));
}

TEST(PreviewOrder, TheSmallerIdIsInFrontAtEqualDistance) {
    EXPECT_EQ(order_of(job_at({-2, -2, -2})), (Indices{0, 1, 2}));
}

TEST(PreviewOrder, TheEarlierLayerIsInFrontAtEqualDistance) {
    OrderJob job = job_at({-2, -2});
    OrderLayer second = job.layers[0];
    job.layers[0].count = 1;
    second.first = second.count = 1;
    job.layers.push_back(second);
    EXPECT_EQ(order_of(job), (Indices{1, 0}));
}

TEST(PreviewOrder, DroppedSplatsAreLeftOut) {
    OrderJob job = job_at({-2, -5, -3});
    Buffer<glm::vec4> places = *job.places;
    places[1].w = -1.0f;
    job.places = std::make_shared<const Buffer<glm::vec4>>(places);
    EXPECT_EQ(order_of(job), (Indices{2, 0}));
}

TEST(PreviewOrder, CountsWhatLiesBeyondADistance) {
    OrderJob job = job_at({-2, -5, -3, -1});
    job.far_from = 2.5;
    EXPECT_EQ(sorted(job).far_count, 2);
    job.far_from = 0.0;
    EXPECT_EQ(sorted(job).far_count, 4);
    job.far_from = 1e30;
    EXPECT_EQ(sorted(job).far_count, 0);
}

TEST(PreviewOrder, ManySplatsAreInOrder) {
    std::vector<float> zs;
    std::uint32_t state = 1;
    for (int i = 0; i < 100000; ++i)
        zs.push_back(-1.0f - float((state = state * 1664525u + 1013904223u) >> 8) * 1e-6f);
    const Indices order = order_of(job_at(zs));
    ASSERT_EQ(order.size(), zs.size());
    for (std::size_t i = 1; i < order.size(); ++i) ASSERT_LE(zs[order[i - 1]], zs[order[i]]);
}

TEST(OrderThread, GivesTheNewestOrderOfASlotOnce) {
    OrderThread thread;
    for (std::uint64_t version = 1; version <= 3; ++version) {
        OrderJob job = job_at({-2, -5, -3});
        job.version = version;
        thread.submit(4, job);
    }
    ASSERT_TRUE(thread.wait(std::chrono::seconds(60)));
    const std::optional<Order> order = thread.take(4);
    ASSERT_TRUE(order.has_value());
    EXPECT_EQ(order->version, 3u);
    EXPECT_FALSE(thread.take(4).has_value());
    EXPECT_FALSE(thread.take(0).has_value());
}

}  // namespace
}  // namespace astrosplat
