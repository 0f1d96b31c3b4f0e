// Captures from their file to the picture: against a second renderer, seen from elsewhere, and bit by bit.
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>

#include "camera/camera.h"
#include "core/color.h"
#include "core/image.h"
#include "core/rotation.h"
#include "pipeline.h"
#include "scene/scene.h"
#include "support/capture.h"
#include "support/frames.h"
#include "support/test.h"

namespace astrosplat {
namespace {

using namespace astrosplat::test;

// A second, slow and simple renderer of captures, to compare ours with: every Gaussian at every pixel, in
// double, as 3D Gaussian Splatting describes it (Kerbl et al. 2023), but sorted by distance from the eye.
// Shares no code with the program but the camera's numbers.

struct EwaSettings {
    double filter_variance = 0.25;  // square px added to every footprint
    bool conserves_light = true;    // the peak sinks as the filter widens it; not so in 3D Gaussian Splatting
    double least_alpha = 0.0;       // what is fainter is not drawn: 1/255 there
};

glm::dmat3 axes_of(const glm::dvec4& q) {
    // The images of the axes under v -> q v q*.
    const auto turn = [&](const glm::dvec3& v) {
        const glm::dvec3 u(q.x, q.y, q.z), t = 2.0 * glm::cross(u, v);
        return v + q.w * t + glm::cross(u, t);
    };
    return {turn({1, 0, 0}), turn({0, 1, 0}), turn({0, 0, 1})};
}

/// The colour in a direction, by products of Cartesian coordinates.
glm::dvec3 color_of(const std::array<glm::dvec3, 16>& c, const glm::dvec3& d) {
    const double x = d.x, y = d.y, z = d.z;
    glm::dvec3 sum = 0.28209479177387814 * c[0];
    sum += 0.4886025119029199 * (-y * c[1] + z * c[2] - x * c[3]);
    sum += 1.0925484305920792 * (x * y * c[4] - y * z * c[5] - x * z * c[7]);
    sum += 0.31539156525252005 * (3 * z * z - 1) * c[6] + 0.5462742152960396 * (x * x - y * y) * c[8];
    sum += -0.5900435899266435 * (y * (3 * x * x - y * y) * c[9] + x * (x * x - 3 * y * y) * c[15]);
    sum += 2.890611442640554 * x * y * z * c[10] + 1.445305721320277 * z * (x * x - y * y) * c[14];
    sum += -0.4570457994644658 * (5 * z * z - 1) * (y * c[11] + x * c[13]);
    sum += 0.3731763325901154 * z * (5 * z * z - 3) * c[12];
    return glm::max(sum + 0.5, glm::dvec3(0.0));
}

/// Red, green and blue in display values over black, and alpha. `camera` is a perspective one.
Image ewa_reference(std::vector<Trained> capture, const Camera& camera, std::int64_t width,
                    std::int64_t height, const EwaSettings& settings = {}) {
    std::ranges::stable_sort(capture, {},
                             [&](const Trained& g) { return glm::distance(g.position, camera.eye); });
    std::vector<glm::dvec4> sums(std::size_t(width * height), glm::dvec4(0.0, 0.0, 0.0, 1.0));
    const glm::dmat3 view = glm::transpose(camera.world_from_camera);
    for (const Trained& g : capture) {
        const glm::dvec3 p = view * (g.position - camera.eye);
        const double depth = -p.z, f = camera.focal_px;
        if (depth < 0.05) continue;
        glm::dmat3 m = view * axes_of(g.rotation);
        for (int k = 0; k < 3; ++k) m[k] *= g.scale[k];
        const glm::dmat3 covariance = m * glm::transpose(m);
        // Rows of the Jacobian of (f x / -z, -f y / -z).
        const glm::dvec3 jx(f / depth, 0.0, f * p.x / (depth * depth)),
            jy(0.0, -f / depth, -f * p.y / (depth * depth));
        const double xx = glm::dot(jx, covariance * jx), xy = glm::dot(jx, covariance * jy),
                     yy = glm::dot(jy, covariance * jy);
        const double before = std::max(xx * yy - xy * xy, 0.0);
        const double wide_xx = xx + settings.filter_variance, wide_yy = yy + settings.filter_variance;
        const double after = wide_xx * wide_yy - xy * xy;
        const double peak = g.opacity * (settings.conserves_light ? std::sqrt(before / after) : 1.0);
        const glm::dvec3 color = color_of(g.harmonics, glm::normalize(g.position - camera.eye));
        const double cx = camera.center_x_px + f * p.x / depth, cy = camera.center_y_px - f * p.y / depth;
        for (std::int64_t y = 0; y < height; ++y)
            for (std::int64_t x = 0; x < width; ++x) {
                const double dx = double(x) + 0.5 - cx, dy = double(y) + 0.5 - cy;
                const double d = (wide_yy * dx * dx - 2.0 * xy * dx * dy + wide_xx * dy * dy) / after;
                if (d > 60.0) continue;  // 1e-13 of the peak
                const double alpha = peak * std::exp(-0.5 * d);
                if (alpha < settings.least_alpha) continue;
                glm::dvec4& sum = sums[std::size_t(y * width + x)];
                sum += glm::dvec4(sum.w * alpha * color, -sum.w * alpha);
            }
    }
    Image image = make_image(width, height, 4);
    for (std::size_t i = 0; i < sums.size(); ++i) {
        for (int k = 0; k < 3; ++k) image.pixels[4 * i + std::size_t(k)] = float(sums[i][k]);
        image.pixels[4 * i + 3] = float(1.0 - sums[i].w);
    }
    return image;
}

constexpr std::int64_t width = 160, height = 120;

struct CaptureScene {
    TempFolder folder;
    Scene scene;
    std::vector<Trained> all;

    explicit CaptureScene(std::vector<Trained> capture, int degree) : all(std::move(capture)) {
        folder.file("capture.ply", ply_of(all, degree));
        scene.output.width = width;
        scene.output.height = height;
        scene.camera.position = glm::dvec3(2.0, 1.5, 6.0);
        scene.camera.target = glm::dvec3(0.2, 0.1, 0.0);
        scene.camera.fov = 60.0;
        LayerParams layer;
        layer.name = "capture";
        layer.source.kind = SourceKind::splats;
        layer.source.file = folder / "capture.ply";
        layer.render.isolate = true;
        layer.render.space = BlendSpace::display;
        scene.layers.push_back(layer);
    }
    LayerParams& layer() { return scene.layers[0]; }
    Image picture() const {
        Pipeline pipeline(scene);
        return frame_of(pipeline, 1.0).beauty;
    }
    Camera camera() const {
        Pipeline pipeline(scene);
        return pipeline.camera(pipeline.frame_scene(1.0), settings_of(pipeline, 1.0));
    }
};

Image displayed(Image image) {
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        if (i % 4 != 3) image.pixels[i] = float(real::linear_to_srgb(image.pixels[i]));
    return image;
}

/// Of colours between 0 and 1, as a display shows them; the peak is 1.
double display_psnr_db(const Image& a, const Image& b) {
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        if (i % 4 == 3) continue;
        const double d =
            std::clamp(double(a.pixels[i]), 0.0, 1.0) - std::clamp(double(b.pixels[i]), 0.0, 1.0);
        sum += d * d;
        count += 1.0;
    }
    return 10.0 * std::log10(count / sum);
}

TEST(Capture, IsWhatAnEwaRendererMakesOfIt) {
    const CaptureScene scene(capture(1000, 3), 3);
    const Image picture = displayed(scene.picture());
    const double psnr = display_psnr_db(picture, ewa_reference(scene.all, scene.camera(), width, height));
    RecordProperty("psnr_db", std::to_string(psnr));
    EXPECT_GT(psnr, 50.0);  // 40 is asked for
    EXPECT_LT(display_psnr_db(picture, displayed(make_image(width, height, 4))), 20.0) << "nothing to see";
}

// The original's 0.3 px, which let what is thin gain light: as good as the same where Gaussians
// span some pixels.
TEST(Capture, IsNearThe3dgsOriginal) {
    for (const double size : {0.25, 2.0}) {
        const CaptureScene scene(capture(400, 3, size), 3);
        const double psnr = display_psnr_db(
            displayed(scene.picture()),
            ewa_reference(scene.all, scene.camera(), width, height, {0.3, false, 1.0 / 255.0}));
        RecordProperty("psnr_db_" + std::to_string(size), std::to_string(psnr));
        EXPECT_GT(psnr, size < 1.0 ? 25.0 : 40.0) << size;
    }
}

// Dust of a fifth of a pixel: their light is what the reference has where its peaks sink, too.
TEST(Capture, KeepsTheLightOfGaussiansBelowAPixel) {
    const CaptureScene scene(capture(1500, 0, 0.02), 0);
    EXPECT_GT(
        display_psnr_db(displayed(scene.picture()), ewa_reference(scene.all, scene.camera(), width, height)),
        45.0);
}

TEST(Capture, InLinearLightIsAnotherPicture) {
    CaptureScene scene(capture(800, 1), 1);
    const Image display = scene.picture();
    scene.layer().render.space = BlendSpace::linear;
    const Image linear = scene.picture();
    EXPECT_LT(display_psnr_db(displayed(display), displayed(linear)), 40.0);
    scene.layer().render.space = BlendSpace::display;
    scene.layer().render.isolate = false;  // without which it does nothing
    EXPECT_EQ(scene.picture().pixels, linear.pixels);
}

// Alpha is what covers in display values; the light is decoded as a whole, over black.
TEST(Capture, OneGaussianIsDecodedAfterMixing) {
    Trained g;
    g.scale = glm::dvec3(1.0, 2.0, 0.5);
    g.opacity = 0.5;
    for (int k = 0; k < 3; ++k) g.harmonics[0][k] = (0.8 - 0.1 * k - 0.5) / 0.28209479177387814;
    CaptureScene scene({g}, 0);
    scene.scene.camera.position = glm::dvec3(0.0, 0.0, 10.0);
    scene.scene.camera.target = glm::dvec3(0.0);
    const Image picture = scene.picture();
    const float* middle = picture.at(width / 2, height / 2);
    EXPECT_NEAR(middle[3], 0.5, 2e-3);
    for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(middle[k], real::srgb_to_linear(0.5 * (0.8 - 0.1 * k)), 2e-3) << k;
}

// Turned, moved and doubled with its camera it looks the same: shapes and harmonics turn with the layer.
TEST(Capture, LooksTheSameFromAMovedLayer) {
    CaptureScene scene(capture(600, 3), 3);
    scene.scene.camera.near = 0.5;
    const Image before = displayed(scene.picture());
    LayerTransform& transform = scene.layer().transform;
    transform.rotate = {40.0, -70.0, 110.0};
    transform.scale = 2.0;
    transform.translate = {5.0, -3.0, 8.0};
    const glm::dmat3 turn = rotation_from_degrees(transform.rotate);
    const auto moved = [&](const glm::dvec3& p) { return 2.0 * (turn * p) + transform.translate; };
    scene.scene.camera.position = moved(*scene.scene.camera.position);
    scene.scene.camera.target = moved(scene.scene.camera.target);
    scene.scene.camera.up = turn * scene.scene.camera.up;
    scene.scene.camera.near = 1.0;
    EXPECT_GT(display_psnr_db(displayed(scene.picture()), before), 70.0);
}

TEST(Capture, ColoursFollowTheEye) {
    CaptureScene scene(capture(300, 2), 2);
    Pipeline pipeline(scene.scene);
    const RenderSettings settings = settings_of(pipeline, 1.0);
    const Image first = pipeline.frame(1.0, settings).beauty;
    Scene moved = scene.scene;
    moved.camera.position = glm::dvec3(-5.0, 1.0, 4.0);
    const auto set = std::make_shared<const SplatSet>(load_source({}, moved.layers[0].source, "capture").set);
    Pipeline other;
    other.set_scene(scene.scene, {set});
    EXPECT_EQ(other.frame(1.0, settings).beauty.pixels, first.pixels);
    other.set_scene(moved, {set});
    EXPECT_EQ(other.frame(1.0, settings).beauty.pixels, Pipeline(moved).frame(1.0, settings).beauty.pixels);
    EXPECT_NE(other.frame(1.0, settings).beauty.pixels, first.pixels);
}

TEST(Capture, DroppedSplatsTakeTheirShapesWithThem) {
    CaptureScene scene(capture(500, 0), 0);
    scene.layer().look.density = 0.4f;
    const Image thinned = scene.picture();
    Pipeline pipeline(scene.scene);
    const std::vector<RenderLayer> layers = pipeline.shaded_layers(pipeline.frame_scene(1.0));
    ASSERT_LT(layers[0].splats->size(), 300);
    ASSERT_GT(layers[0].splats->size(), 100);
    std::vector<Trained> kept;
    for (const std::uint64_t id : layers[0].splats->id) kept.push_back(scene.all[id]);
    EXPECT_GT(display_psnr_db(displayed(thinned), ewa_reference(kept, scene.camera(), width, height)), 50.0);
}

TEST(Capture, HasTheSameBitsOnThreadsTilesAndInstructionSets) {
    const CaptureScene scene(capture(700, 3), 3);
    const Image expected = scene.picture();
    test::expect_same_bits([&] { return test::Bits() << scene.picture(); });
    Pipeline pipeline(scene.scene);
    RenderSettings settings = settings_of(pipeline, 1.0);
    settings.tile_px = 16;
    EXPECT_EQ(pipeline.frame(1.0, settings).beauty.pixels, expected.pixels);
    settings.region = {40, 30, 64, 48};
    const Image part = pipeline.frame(1.0, settings).beauty;
    for (std::int64_t y = 0; y < 48; ++y)
        for (std::int64_t x = 0; x < 64; ++x)
            for (int k = 0; k < 4; ++k) ASSERT_EQ(part.at(x, y)[k], expected.at(40 + x, 30 + y)[k]);
}

// Wide and low in the middle of a dome, as it is to the eye.
TEST(Capture, KeepsItsLightAndShapeInDomes) {
    Trained g;
    g.scale = glm::dvec3(0.4, 0.1, 0.2);
    g.opacity = 0.5;
    CaptureScene scene({g}, 0);
    scene.layer().render.isolate = false;
    scene.scene.camera.projection = Projection::fisheye;
    scene.scene.camera.position = glm::dvec3(0.0, 0.0, 5.0);
    scene.scene.camera.target = glm::dvec3(0.0);
    const Camera camera = scene.camera();
    double alpha = 0.0, wide = 0.0, high = 0.0;
    const Image picture = scene.picture();
    for (std::int64_t y = 0; y < picture.height; ++y)
        for (std::int64_t x = 0; x < picture.width; ++x) {
            const double a = picture.at(x, y)[3], right = double(x) + 0.5 - camera.center_x_px,
                         down = double(y) + 0.5 - camera.center_y_px;
            alpha += a;
            wide += a * right * right;
            high += a * down * down;
        }
    const double px = camera.focal_px / 5.0;
    EXPECT_NEAR(alpha / (0.5 * 2.0 * 3.14159265 * 0.4 * 0.1 * px * px), 1.0, 0.02);
    EXPECT_NEAR(wide / alpha / (0.4 * 0.4 * px * px + 0.25), 1.0, 0.03);
    EXPECT_NEAR(high / alpha / (0.1 * 0.1 * px * px + 0.25), 1.0, 0.03);
}

}  // namespace
}  // namespace astrosplat
