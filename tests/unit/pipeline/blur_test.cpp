// Motion blur and depth of field: the means of renderings against means made by hand, the thin lens in closed
// form, and no trace of either where they are off.
#include <glm/matrix.hpp>

#include "camera/camera.h"
#include "camera/projection.h"
#include "pipeline.h"
#include "support/frames.h"
#include "support/small_scene.h"
#include "support/test.h"

namespace astrosplat {
namespace {

/// Peak is the reference's brightest value.
double psnr_db(const Image& image, const Image& reference) {
    double sum = 0.0, peak = 0.0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const double d = double(image.pixels[i]) - double(reference.pixels[i]);
        sum += d * d;
        peak = std::max(peak, double(reference.pixels[i]));
    }
    return 10.0 * std::log10(peak * peak * double(image.pixels.size()) / sum);
}

double light(const Image& image) {
    double sum = 0.0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        if (i % 4 != 3) sum += image.pixels[i];
    return sum;
}

/// The camera passes by; frames 1 to 11.
struct MovingScene : SmallScene {
    MovingScene() {
        Track track{ParameterKey("camera.position"), {}};
        track.keyframes.emplace_back(1.0, std::vector<double>{-16.0, 6.0, 12.0}, Interpolation::linear);
        track.keyframes.emplace_back(11.0, std::vector<double>{24.0, 6.0, 12.0}, Interpolation::linear);
        scene.animation = {track};
    }
};

Image picture_of(const Scene& scene, double frame) {
    Pipeline pipeline(scene);
    return frame_of(pipeline, frame).beauty;
}

TEST(Blur, SamplesFillShutterAndAperture) {
    CameraParams params;
    params.shutter = 180.0;
    constexpr int n = 48;
    std::set<double> times;
    glm::dvec2 middle(0.0);
    double together = 0.0, inner = 0.0;
    for (int i = 0; i < n; ++i) {
        const CameraSample sample = camera_sample(params, i, n);
        times.insert(sample.frames);
        middle += sample.lens / double(n);
        together += sample.frames * sample.lens.x;
        inner += glm::length(sample.lens) < std::sqrt(0.5) ? 1.0 : 0.0;
        EXPECT_LT(glm::length(sample.lens), 1.0);
    }
    ASSERT_EQ(times.size(), std::size_t{n});
    double expected = -0.25 + 0.25 / n;  // half a frame open, in equal steps around its own time
    for (const double time : times) {
        EXPECT_NEAR(time, expected, 1e-12);
        expected += 0.5 / n;
    }
    EXPECT_LT(glm::length(middle), 0.03);
    EXPECT_NEAR(inner, n / 2, 1.0);
    EXPECT_LT(std::fabs(together) / n, 0.01) << "places that go with times would smear to one side";
}

// A thin lens of the radius a at the distance D shifts by f a (1 / S - 1 / D) against the plane of focus S.
TEST(Blur, TheLensIsThin) {
    CameraParams params;
    params.position = glm::dvec3(0.0, 0.0, 10.0);
    params.focal_length = 50.0;
    params.f_number = 2.0;
    params.focus_distance = 4.0;
    params.unit_mm = 100.0;
    const Camera camera = make_camera(params, 720, 480, {});
    const double radius = 0.5 * 50.0 / 2.0 / 100.0;
    const glm::dvec2 place(0.6, -0.3);
    const Camera seen = through_lens(camera, params, place, 720);
    const auto at = [](const Camera& c, const glm::dvec3& p) {
        const exact::Instance i =
            exact::instance_of(make_exact_lens(c), glm::transpose(c.world_from_camera) * (p - c.eye));
        return glm::dvec2(i.x_px, i.y_px);
    };
    for (const double distance : {1.0, 4.0, 9.0}) {
        const glm::dvec3 p(0.2, -0.1, 10.0 - distance);
        const glm::dvec2 moved = at(seen, p) - at(camera, p);
        const double scale = 720.0 * 50.0 / 36.0 * radius * (1.0 / 4.0 - 1.0 / distance);
        EXPECT_NEAR(moved.x, scale * place.x, 1e-9) << distance;
        EXPECT_NEAR(moved.y, -scale * place.y, 1e-9) << distance;
    }
    params.focus_distance = 0.0;  // at the target
    const Camera at_target = through_lens(camera, params, place, 720);
    EXPECT_LT(glm::length(at(at_target, {0.3, 0.4, 0.0}) - at(camera, {0.3, 0.4, 0.0})), 1e-9);
    // A camera without a position looks at the middle of what it frames, wherever `target` lies.
    params.position.reset();
    params.target = {50.0, 60.0, 70.0};
    Bounds box;
    box.add(glm::dvec3(9.0, 19.0, -31.0));
    box.add(glm::dvec3(11.0, 21.0, -29.0));
    const Camera automatic = make_camera(params, 720, 480, box);
    const Camera focused = through_lens(automatic, params, place, 720);
    EXPECT_LT(glm::length(at(focused, box.center()) - at(automatic, box.center())), 1e-9);
}

TEST(Blur, OffLeavesNoTrace) {
    MovingScene small;
    const Image plain = picture_of(small.scene, 6.0);
    small.scene.output.samples = 3;
    small.scene.camera.focus_distance = 3.0;
    EXPECT_EQ(picture_of(small.scene, 6.0).pixels, plain.pixels);
    small.scene.camera.projection = Projection::orthographic;
    const Image parallel = picture_of(small.scene, 6.0);
    small.scene.camera.f_number = 1.0;  // there is no lens
    EXPECT_EQ(picture_of(small.scene, 6.0).pixels, parallel.pixels);
}

TEST(Blur, AnOpenShutterGivesTheMeanOverItsTime) {
    MovingScene small;
    constexpr int steps = 200;
    Image reference;
    {
        Pipeline pipeline(small.scene);
        for (int i = 0; i < steps; ++i) {
            const double time = 6.0 + 0.5 * ((i + 0.5) / steps - 0.5);
            const Image one = frame_of(pipeline, time).beauty;
            if (reference.pixels.empty()) reference = make_image(one.width, one.height, 4);
            for (std::size_t k = 0; k < one.pixels.size(); ++k) reference.pixels[k] += one.pixels[k] / steps;
        }
    }
    const double sharp_db = psnr_db(picture_of(small.scene, 6.0), reference);
    small.scene.camera.shutter = 180.0;
    const Image blurred = picture_of(small.scene, 6.0);
    EXPECT_GT(psnr_db(blurred, reference), 45.0);
    EXPECT_LT(sharp_db, 40.0) << "or there is nothing to blur";
}

TEST(Blur, DepthOfFieldKeepsLightAndConverges) {
    SmallScene small;
    for (LayerParams& layer : small.scene.layers) layer.render.blend = Blend::add;
    const Image sharp = picture_of(small.scene, 1.0);
    CameraParams& camera = small.scene.camera;
    camera.f_number = 0.03;
    camera.focus_distance = 8.0;
    small.scene.output.samples = 1024;
    const Image reference = picture_of(small.scene, 1.0);
    small.scene.output.samples = 64;
    const Image blurred = picture_of(small.scene, 1.0);
    EXPECT_NEAR(light(blurred) / light(sharp), 1.0, 0.005);
    EXPECT_GT(psnr_db(blurred, reference), 40.0);
    EXPECT_LT(psnr_db(sharp, reference), 39.0) << "or there is nothing to blur";
}

/// Behind nothing and before a sky, under which beauty's alpha is 1 everywhere.
class BlurBeforeASky : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Off, BlurBeforeASky, testing::Values(false));
INSTANTIATE_TEST_SUITE_P(On, BlurBeforeASky, testing::Values(true));

TEST_P(BlurBeforeASky, DepthsAreWeightedByTheAlphaOfSplats) {
    MovingScene small;
    small.scene.camera.shutter = 360.0;
    small.scene.output.aovs = {"depth", "coverage", "count", "layers"};
    small.scene.output.samples = 4;
    Scene before_sky = small.scene;
    if (GetParam()) before_sky.environment.image = small.folder / "picture.ppm";
    Pipeline blurred(before_sky);
    const RenderedFrame frame = frame_of(blurred, 6.0);
    const CameraParams params = small.scene.camera;
    small.scene.camera.shutter = 0.0;
    Pipeline plain(small.scene);
    Image sum = make_image(160, 100, 1), weight = sum, coverage = sum, light_of_gas = sum;
    RenderStatistics mean;
    for (int i = 0; i < 4; ++i) {
        const double time = 6.0 + camera_sample(params, i, 4).frames;
        const RenderedFrame one = frame_of(plain, time);
        for (std::size_t k = 0; k < sum.pixels.size(); ++k) {
            sum.pixels[k] += one.depth.pixels[k] * one.beauty.pixels[4 * k + 3];
            weight.pixels[k] += one.beauty.pixels[4 * k + 3];
            coverage.pixels[k] += one.coverage.pixels[k] / 4.0f;
            light_of_gas.pixels[k] += one.layers[0].pixels[4 * k] / 4.0f;
        }
        mean.splats_in += one.statistics.splats_in / 4;
        mean.mean_overlap += one.statistics.mean_overlap / 4.0;
    }
    for (std::size_t k = 0; k < sum.pixels.size(); ++k) {
        const float depth = weight.pixels[k] > 0.0f ? sum.pixels[k] / weight.pixels[k] : 0.0f;
        ASSERT_NEAR(frame.depth.pixels[k], depth, 1e-4f * depth);
        ASSERT_NEAR(frame.coverage.pixels[k], coverage.pixels[k], 1e-5f);
        ASSERT_NEAR(frame.layers[0].pixels[4 * k], light_of_gas.pixels[k], 1e-5f);
    }
    EXPECT_NEAR(double(frame.statistics.splats_in), double(mean.splats_in), 4.0);
    if (!GetParam()) {  // a sky covers every pixel
        EXPECT_NEAR(frame.statistics.mean_overlap, mean.mean_overlap, 1e-9);
    }
}

/// Light and alpha of all layers.
Image sum_of_layers(const RenderedFrame& frame) {
    Image sum = make_image(frame.beauty.width, frame.beauty.height, 4);
    for (const Image& layer : frame.layers)
        for (std::size_t k = 0; k < sum.pixels.size(); ++k) sum.pixels[k] += layer.pixels[k];
    return sum;
}

TEST(Blur, LayersThatComeAndGoWithinTheShutterKeepTheirPlaces) {
    for (const char* const key : {"layer.gas.visible", "layer.dust.visible"})
        for (const auto& [at_first, later] : {std::pair{1.0, 0.0}, std::pair{0.0, 1.0}}) {
            SmallScene small;
            for (LayerParams& layer : small.scene.layers) layer.render.blend = Blend::over;
            small.scene.camera.shutter = 360.0;
            small.scene.output.aovs = {"layers"};
            small.scene.output.samples = 5;
            Track track{ParameterKey(key), {}};
            track.keyframes.emplace_back(1.0, std::vector<double>{at_first}, Interpolation::step);
            track.keyframes.emplace_back(6.1, std::vector<double>{later}, Interpolation::step);
            small.scene.animation = {track};
            Pipeline pipeline(small.scene);
            const RenderedFrame frame = frame_of(pipeline, 6.0);
            EXPECT_EQ(pipeline.layer_names(pipeline.frame_scene(6.0)),
                      (std::vector<std::string>{"gas", "dust"}));
            ASSERT_EQ(frame.layers.size(), 2u);
            const Image sum = sum_of_layers(frame);
            for (std::size_t k = 0; k < sum.pixels.size();
                 ++k)  // alpha ends at exactly 1, 2^-16 before it is
                ASSERT_NEAR(sum.pixels[k], frame.beauty.pixels[k], k % 4 == 3 ? 0x1p-16f + 1e-6f : 1e-5f)
                    << key << at_first;
        }
}

}  // namespace
}  // namespace astrosplat
