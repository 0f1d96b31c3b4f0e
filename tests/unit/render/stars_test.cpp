// Stars through the whole renderer: their light at every place and size of their image, what flying past,
// other lenses and splats before them do to it, and the same bits for every tile size,
// thread and instruction set.
#include "camera/projection.h"
#include "support/test.h"
#include "unit/render/sphere_scenes.h"

namespace astrosplat {
namespace {

using namespace astrosplat::test;

constexpr int frame_px = 256;

Camera star_camera(double fov_deg = 40.0) {
    CameraParams params;
    params.position = glm::dvec3(0.0);
    params.target = {0.0, 0.0, -1.0};
    params.fov = fov_deg;
    return make_camera(params, frame_px, frame_px, {});
}

RenderLayer star_layer(const ShadedSplats& splats, const StarPsf& psf = {}) {
    RenderLayer layer = layer_of("stars", splats);
    layer.stars = psf;
    return layer;
}

OneSplat star_at(const glm::vec3& position, float light = 1.0f) {
    return {position, 0.0f, 1.0f, glm::vec3(light, 0.5f * light, 0.25f * light)};
}

Image picture_of(std::span<const RenderLayer> layers, const Camera& camera) {
    return render(layers, camera, nullptr, settings_of(frame_px, frame_px)).beauty;
}

/// Middle of the light of a channel, px.
glm::dvec2 centroid(const Image& image) {
    glm::dvec2 sum(0.0);
    for (std::int64_t y = 0; y < image.height; ++y)
        for (std::int64_t x = 0; x < image.width; ++x)
            sum += glm::dvec2(double(x) + 0.5, double(y) + 0.5) * double(image.at(x, y)[0]);
    return sum / total(image, 0);
}

/// Where a place seen px to the right and down of the middle lies, 10 units away.
glm::vec3 place_at(const Camera& camera, double x_px, double y_px) {
    return {float(10.0 * x_px / camera.focal_px), float(-10.0 * y_px / camera.focal_px), -10.0f};
}

TEST(Stars, KeepTheirLightAndPlaceAtEverySizeAndOffset) {
    const Camera camera = star_camera();
    for (const float core_px : {0.5f, 0.7f, 1.0f, 2.0f, 4.0f})
        for (const double offset : {0.0, 0.1, 0.2, 0.37, 0.5, 0.83}) {
            const ShadedSplats splats =
                make_splats({star_at(place_at(camera, offset, 3.0 + 0.5 * offset), 8.0f)});
            const RenderLayer layer = star_layer(splats, {.core_px = core_px});
            const Image picture = picture_of({&layer, 1}, camera);
            EXPECT_NEAR(total(picture, 0), 8.0, 0.016) << core_px << " px, offset " << offset;
            EXPECT_NEAR(total(picture, 2), 2.0, 0.004) << core_px << " px, offset " << offset;
            const glm::dvec2 middle = centroid(picture);
            EXPECT_NEAR(middle.x, 128.0 + offset, 0.05) << core_px;
            EXPECT_NEAR(middle.y, 131.0 + 0.5 * offset, 0.05) << core_px;
        }
}

TEST(Stars, AreAsWideAsTheirCoreWhateverTheFieldOfView) {
    const ShadedSplats splats = make_splats({star_at({0.0f, 0.0f, -50.0f})});
    for (const float core_px : {0.8f, 1.5f, 3.0f})
        for (const double fov : {90.0, 40.0, 2.0}) {
            const RenderLayer layer = star_layer(splats, {.core_px = core_px});
            const Image picture = picture_of({&layer, 1}, star_camera(fov));
            double variance = 0.0;
            for (std::int64_t y = 0; y < frame_px; ++y)
                for (std::int64_t x = 0; x < frame_px; ++x)
                    variance += std::pow(double(x) - 127.5, 2.0) * double(picture.at(x, y)[0]);
            EXPECT_NEAR(std::sqrt(variance / total(picture, 0)), core_px, 0.05 * core_px)
                << fov << " degrees";
        }
}

TEST(Stars, WingsAndSpikesTakeTheirLightFromTheCore) {
    const ShadedSplats splats = make_splats({star_at({0.0f, 0.0f, -50.0f}, 5000.0f)});
    StarPsf psf{
        .wing_share = 0.3f, .wing_px = 8.0f, .wing_power = 3.0f, .spike_share = 0.2f, .spike_px = 12.0f};
    for (const int vanes : {3, 4}) {
        psf.vanes = vanes;
        psf.vane_deg = 90.0f;
        const RenderLayer layer = star_layer(splats, psf), core = star_layer(splats);
        const Image picture = picture_of({&layer, 1}, star_camera()),
                    bare = picture_of({&core, 1}, star_camera());
        EXPECT_NEAR(total(picture, 0), 5000.0, 50.0) << vanes << " vanes";
        EXPECT_NEAR(picture.at(128, 128)[0] / bare.at(128, 128)[0], 0.5, 0.12);
        // Around a circle well outside of the core: as many maxima as spikes.
        std::vector<double> ring;
        for (int i = 0; i < 360; ++i) {
            const double turn = 2.0 * 3.14159265358979 * i / 360.0;
            ring.push_back(picture.at(std::int64_t(128.0 + 30.0 * std::cos(turn)),
                                      std::int64_t(128.0 - 30.0 * std::sin(turn)))[0]);
        }
        const auto is_bright = [&](int i) { return ring[(i + 360) % 360] > 0.3 * ring[90]; };
        int spikes = 0;
        for (int i = 0; i < 360; ++i) spikes += is_bright(i) && !is_bright(i - 1) ? 1 : 0;
        EXPECT_EQ(spikes, vanes == 3 ? 6 : 4);
        EXPECT_TRUE(is_bright(90) && is_bright(270)) << "the first vane is upright";
        EXPECT_EQ(is_bright(0), vanes == 4);
        EXPECT_EQ(is_bright(30), vanes == 3);
    }
}

/// A star's spikes at so many px around its place: to the right and left, up and down, and the brightest
/// between them.
struct Spikes {
    double level = 0.0, upright = 0.0, between = 0.0;
};
Spikes spikes_at(const Image& picture, const Camera& camera, const glm::dvec3& toward, double px) {
    const shared::Instance at = shared::instance_of(make_lens(camera), glm::vec3(toward));
    const auto light = [&](double right, double down) {
        double sum = 0.0;  // over 5 x 5 px
        for (int y = -2; y <= 2; ++y)
            for (int x = -2; x <= 2; ++x)
                sum += double(picture.at(std::int64_t(double(at.x_px) + right) + x,
                                         std::int64_t(double(at.y_px) + down) + y)[0]);
        return sum;
    };
    const double diagonal = px / std::sqrt(2.0);
    return {light(px, 0.0) + light(-px, 0.0), light(0.0, px) + light(0.0, -px),
            std::max({light(diagonal, diagonal), light(diagonal, -diagonal), light(-diagonal, diagonal),
                      light(-diagonal, -diagonal)})};
}

// As on a flat frame: so many px long, level and upright in the frame, and with the light that solid angles
// have there.
TEST(Stars, HaveTheirSpikesOnDomesAndPanoramas) {
    const StarPsf psf{.core_px = 1.0f, .spike_share = 0.4f, .spike_px = 12.0f};
    const auto picture_to = [&](const Camera& camera, const glm::dvec3& toward, const RenderSettings& s) {
        const ShadedSplats splats = make_splats({star_at(glm::vec3(50.0 * toward), 5000.0f)});
        const RenderLayer layer = star_layer(splats, psf);
        return render({&layer, 1}, camera, nullptr, s).beauty;
    };
    const glm::dvec3 ahead(0.0, 0.0, -1.0);
    const Image flat = picture_to(star_camera(), ahead, settings_of(frame_px, frame_px));
    for (const Projection projection : projections) {
        CameraParams params = params_of(projection);
        params.fisheye_fov = 180.0;
        const RenderSettings settings = settings_of(projection == Projection::fisheye ? 512 : 1024, 512);
        const Camera camera = make_camera(params, double(settings.width), double(settings.height), {});
        for (const glm::dvec2& place : {glm::dvec2(0.1, 0.1), {51.0, 3.0}, {-23.0, 33.0}, {150.0, -12.0}}) {
            if (projection == Projection::fisheye && place.x > 90.0) continue;
            const glm::dvec3 toward = direction(place.x, place.y);
            const Image picture = picture_to(camera, toward, settings);
            SCOPED_TRACE(std::string(name_of(projection)) + ", longitude " + std::to_string(place.x));
            EXPECT_NEAR(light_on_sphere(picture, solid_angles(camera), 0), 5000.0, 25.0);
            const shared::Instance at = shared::instance_of(make_lens(camera), glm::vec3(toward));
            const double area = 1.0 / solid_angle(camera, std::int64_t(at.x_px), std::int64_t(at.y_px));
            for (const double px : {12.0, 24.0}) {
                const Spikes wanted = spikes_at(flat, star_camera(), ahead, px),
                             found = spikes_at(picture, camera, toward, px);
                EXPECT_NEAR(found.level / (area * wanted.level), 1.0, 0.1) << px << " px";
                EXPECT_NEAR(found.upright / (area * wanted.upright), 1.0, 0.1) << px << " px";
                EXPECT_LT(found.between, 0.05 * found.upright) << px << " px";
            }
        }
    }
}

// As gentle as one star's own: what is too faint for its wing is not cut off.
TEST(Stars, FaintOnesHaveNoWingsAndLoseNothing) {
    StarPsf psf{.wing_share = 0.5f, .wing_px = 6.0f, .wing_power = 2.0f};
    double before = 0.0;
    for (float light = 0.0005f; light < 50.0f; light *= 1.25f) {
        const ShadedSplats splats = make_splats({star_at({0.0f, 0.0f, -50.0f}, light)});
        const RenderLayer layer = star_layer(splats, psf);
        const Image picture = picture_of({&layer, 1}, star_camera());
        EXPECT_NEAR(total(picture, 0) / light, 1.0, 0.01) << light;
        const double peak = picture.at(128, 128)[0];
        EXPECT_GT(peak, before) << "a brighter star is never darker in the middle";
        before = peak;
    }
}

TEST(Stars, GrowBrighterAsOneFliesPastUnlessAtInfinity) {
    const ShadedSplats splats = make_splats({star_at({0.0f, 0.0f, -40.0f}), star_at({0.0f, 3e17f, -1e18f})});
    const RenderLayer layer = star_layer(splats);
    const auto light = [&](double z, bool lower) {
        Camera camera = star_camera();
        camera.eye = {0.0, 0.0, z};
        const Image picture = picture_of({&layer, 1}, camera);
        double sum = 0.0;
        for (std::int64_t y = lower ? 100 : 0; y < (lower ? 156 : 100); ++y)
            for (std::int64_t x = 0; x < frame_px; ++x) sum += picture.at(x, y)[0];
        return sum;
    };
    for (const double z : {0.0, -20.0, -39.0, 120.0})
        EXPECT_NEAR(light(z, true), std::pow(40.0 / (40.0 + z), 2.0), 0.01 * std::pow(40.0 / (40.0 + z), 2.0))
            << z;
    for (const double z : {0.0, -20.0, -39.0, -80.0}) EXPECT_NEAR(light(z, false), 1.0, 0.01) << z;
    Camera faded = star_camera();
    faded.eye = {0.0, 0.0, -39.9};
    faded.near_fade = 4.0;  // no nearer than that counts
    EXPECT_LT(total(picture_of({&layer, 1}, faded), 0), 1.0 + std::pow(40.0 / 4.0, 2.0));
    faded.far = 1.0;
    faded.eye = {0.0, 0.0, 0.0};
    EXPECT_NEAR(total(picture_of({&layer, 1}, faded), 0), 1.0, 0.01) << "what is at infinity has no far side";
}

// No twinkling, as a slow pan would show it: 40 frames of .1 px over a field of stars, some of them faint,
// in a frame wide enough that all stay inside.
TEST(Stars, KeepTheirLightWhileTheCameraPans) {
    constexpr int stars = 64, frames = 40;
    for (const float core_px : {0.6f, 1.0f}) {
        const Camera camera = star_camera();
        std::vector<OneSplat> many;
        double light = 0.0;
        for (int n = 0; n < stars; ++n) {
            const double x = -98.0 + 26.0 * (n % 8) + 0.37 * n, y = -98.0 + 26.0 * (n / 8) + 0.11 * n;
            many.push_back(star_at(place_at(camera, x, y), 0.01f * std::exp(0.1f * float(n))));
            light += double(many.back().color.x);
        }
        const ShadedSplats splats = make_splats(many);
        const RenderLayer layer = star_layer(splats, {.core_px = core_px, .wing_share = 0.2f});
        std::vector<double> first;
        for (int frame = 0; frame < frames; ++frame) {
            Camera panned = camera;
            panned.center_x_px += 0.1 * frame - 2.0;
            const Image picture = picture_of({&layer, 1}, panned);
            ASSERT_NEAR(total(picture, 0) / light, 1.0, 0.002) << "frame " << frame;
            for (int n = 0; n < stars; n += 9) {
                const double x = panned.center_x_px - 98.0 + 26.0 * (n % 8) + 0.37 * n,
                             y = panned.center_y_px - 98.0 + 26.0 * (n / 8) + 0.11 * n;
                double sum = 0.0;
                for (auto j = std::int64_t(y) - 11; j <= std::int64_t(y) + 11; ++j)
                    for (auto i = std::int64_t(x) - 11; i <= std::int64_t(x) + 11; ++i)
                        sum += double(picture.at(i, j)[0]);
                if (frame == 0) first.push_back(sum);
                ASSERT_NEAR(sum / first[std::size_t(n / 9)], 1.0, 0.02)
                    << "star " << n << ", frame " << frame;
            }
        }
    }
}

// Stars that were measured in a picture's pixels are as bright among its splats in any frame and lens.
TEST(Stars, OfAPictureCoverWhatTheirPixelsDid) {
    const ShadedSplats splats = make_splats({star_at({0.0f, 3.0f, -40.0f})});
    RenderLayer layer = star_layer(splats);
    const Camera camera = star_camera();
    layer.star_pixels.from = camera.eye;
    layer.star_pixels.side_at_1 = 1.0 / camera.focal_px;
    EXPECT_NEAR(total(picture_of({&layer, 1}, camera), 0), 1.0, 0.01);
    Camera closer = camera;
    closer.eye = {0.0, 3.0, -20.0};
    const double way = std::hypot(3.0, 40.0) / 20.0;
    EXPECT_NEAR(total(picture_of({&layer, 1}, closer), 0), way * way, 0.01 * way * way);
    const Camera narrow = star_camera(20.0);
    const double longer = narrow.focal_px / camera.focal_px;
    EXPECT_NEAR(total(picture_of({&layer, 1}, narrow), 0), longer * longer, 0.01 * longer * longer);
    CameraParams params;
    params.projection = Projection::orthographic;
    params.position = glm::dvec3(0.0);
    params.target = {0.0, 0.0, -1.0};
    params.height = 40.0;
    const Camera parallel = make_camera(params, frame_px, frame_px, {});
    const double side_px_there = std::hypot(3.0, 40.0) / camera.focal_px * parallel.focal_px;
    EXPECT_NEAR(total(picture_of({&layer, 1}, parallel), 0), side_px_there * side_px_there, 0.01);
    layer.star_pixels = {glm::dvec3(0.0), 0.0, 2.0 / parallel.focal_px};
    EXPECT_NEAR(total(picture_of({&layer, 1}, parallel), 0), 4.0, 0.04);
    layer.scale = 0.5;
    EXPECT_NEAR(total(picture_of({&layer, 1}, parallel), 0), 1.0, 0.01) << "pixels shrink with the layer";
}

TEST(Stars, AreHiddenByWhatLiesBeforeThem) {
    const ShadedSplats stars = make_splats({star_at({0.0f, 0.0f, -40.0f})});
    for (const float z : {-20.0f, -60.0f}) {
        const ShadedSplats cloud = make_splats({{{0.0f, 0.0f, z}, 8.0f, 0.75f, glm::vec3(0.0f)}});
        const RenderLayer layers[] = {layer_of("cloud", cloud), star_layer(stars)};
        EXPECT_NEAR(total(picture_of(layers, star_camera()), 0), z > -40.0f ? 0.25 : 1.0, 0.01) << z;
    }
}

TEST(Stars, HaveTheSameBitsHoweverThePictureIsMade) {
    std::vector<OneSplat> many;
    for (std::uint32_t n = 0; n < 300; ++n) {
        const auto random = [n](std::uint32_t purpose) {
            return shared::as_uniform(shared::as_hash(5u, n, 0u, purpose));
        };
        many.push_back(star_at({40.0f * random(1) - 20.0f, 40.0f * random(2) - 20.0f,
                                -30.0f - 5.0f * std::floor(4.0f * random(3))},
                               std::exp(12.0f * random(4) - 8.0f)));
    }
    const ShadedSplats stars = make_splats(many);
    const ShadedSplats cloud = make_splats({{{0.0f, 0.0f, -40.0f}, 12.0f, 0.6f, glm::vec3(0.3f)}});
    const RenderLayer layers[] = {layer_of("cloud", cloud),
                                  star_layer(stars, {.wing_share = 0.2f, .spike_share = 0.1f})};
    const auto picture = [&](const RenderSettings& settings) {
        return render(layers, star_camera(), nullptr, settings).beauty;
    };
    expect_same_picture(picture, settings_of(frame_px, frame_px), 200000, {{20, 9, 41, 50}});
}

}  // namespace
}  // namespace astrosplat
