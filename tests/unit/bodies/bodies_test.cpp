// Whole pictures on meshes, and what carries them.
#include <map>

#include "bodies/bodies.h"

#include "bodies/front_fit.h"
#include "bodies/margin.h"
#include "bodies/picture_splats.h"
#include "bodies/uv_surface.h"
#include "camera/camera.h"
#include "core/color.h"
#include "image/blur.h"
#include "image/channels.h"
#include "image/resample.h"
#include "render/render.h"
#include "support/painted_picture.h"
#include "support/printing.h"
#include "support/test.h"
#include "unit/bodies/bodies_support.h"

namespace astrosplat {
namespace {

double sum_of(const Image& image) {
    double sum = 0.0;
    for (const float value : image.pixels) sum += double(value);
    return sum;
}

std::vector<SurfacePlace> places(const UvSurface& surface, glm::vec2 uv) {
    std::vector<SurfacePlace> found;
    surface.at(uv, [&](const SurfacePlace& place) { found.push_back(place); });
    return found;
}

std::int64_t told_bytes(const std::vector<TexturedMesh>& meshes, const StructureParams& params) {
    return bodies_memory_bytes(meshes, params, expected_splats(meshes, params));
}

TEST(Bodies, PicturesThatDoNotFitAreReducedAsFarAsIsNeeded) {
    const StructureParams sheet = of_kind(StructureKind::sheet);
    std::vector<TexturedMesh> meshes{on_plane(painted::nebula(1024, 640)),
                                     on_plane(painted::nebula(256, 160))};
    const double before = sum_of(meshes[0].textures[0].image) / (1024.0 * 640.0);
    const std::int64_t whole = told_bytes(meshes, sheet);
    reduce_pictures(meshes, sheet, {whole, 0}, "gas");
    EXPECT_EQ(meshes[0].textures[0].image.width, 1024);  // it fits
    reduce_pictures(meshes, sheet, {whole / 3, 0}, "gas");
    const Image& reduced = meshes[0].textures[0].image;
    EXPECT_LE(told_bytes(meshes, sheet), whole / 3);
    EXPECT_GT(told_bytes(meshes, sheet), whole / 3 * 85 / 100);
    const auto texels = double(reduced.width * reduced.height);
    EXPECT_NEAR(double(reduced.width) / double(reduced.height), 1.6, 0.01);
    EXPECT_NEAR(sum_of(reduced) / texels, before, 0.003 * before);
    EXPECT_EQ(meshes[1].textures[0].image.width, 256);
    reduce_pictures(meshes, sheet, {1, 0}, "gas");  // to no less than 64 px
    EXPECT_EQ(meshes[0].textures[0].image.height, 64);
}

// As many as were asked for, or up to 15 % less.
TEST(Bodies, PicturesOfMoreSplatsThanAskedForAreReducedUntilTheyAreNot) {
    for (const StructureKind kind : {StructureKind::sheet, StructureKind::disk}) {
        const bool disk = kind == StructureKind::disk;
        std::vector<TexturedMesh> meshes{
            on_plane(disk ? painted::galaxy(800, 500) : painted::nebula(800, 500))};
        const std::int64_t room = 2 * told_bytes(meshes, of_kind(kind));
        const std::int64_t asked = expected_splats(meshes, of_kind(kind)) * 2 / 3;
        reduce_pictures(meshes, of_kind(kind), {room, asked}, "gas");
        EXPECT_LT(meshes[0].textures[0].image.width, 800);
        const std::int64_t made = make_bodies(meshes, of_kind(kind), 3u, "gas").size();
        EXPECT_LE(made, asked);
        EXPECT_GE(made, asked * 85 / 100);
    }
}

// Noise on black sky: splats of every band nearly everywhere.
TEST(Bodies, AreNeverMoreThanTheMostForTheirSize) {
    Image noise = painted::galaxy(320, 200);
    for (std::size_t i = 0; i < noise.pixels.size(); ++i)
        noise.pixels[i] = float(painted::random(std::uint32_t(i), 1));
    for (const StructureKind kind : {StructureKind::sheet, StructureKind::disk}) {
        const auto made = double(make_bodies({on_plane(noise)}, of_kind(kind), 3u, "gas").size());
        const double most = splats_at_most(320, 200, of_kind(kind));
        EXPECT_LE(made, most);
        // Of a disk's places both families may have what is sharp, but hardly do.
        EXPECT_GE(made, (kind == StructureKind::disk ? 0.4 : 0.5) * most);
    }
}

// The estimate knows nothing of a mesh that shows its picture twice.
TEST(Bodies, AreNeverMoreThanAskedFor) {
    TexturedMesh twice = on_plane(painted::nebula(320, 200));
    const std::vector<Mesh::Triangle> faces = twice.mesh.triangles;
    twice.mesh.triangles.insert(twice.mesh.triangles.end(), faces.begin(), faces.end());
    const StructureParams sheet = of_kind(StructureKind::sheet);
    const std::int64_t all = make_bodies({twice}, sheet, 3u, "gas").size();
    for (const std::int64_t most : {all / 2, all / 5, std::int64_t{400}}) {
        const std::int64_t made = make_bodies({twice}, sheet, 3u, "gas", {}, most).size();
        EXPECT_LE(made, most);
        EXPECT_GE(made, most / 4);
    }
    EXPECT_LE(make_bodies({on_plane(make_image(300, 1, 3, 0.5f))}, sheet, 3u, "gas", {}, 100).size(), 100);
    EXPECT_THROW(make_bodies({twice}, sheet, 3u, "gas", {}, 1), InputError);
}

TEST(Bodies, PicturesOfMoreTexelsThanTheMostAreReduced) {
    std::vector<TexturedMesh> meshes{on_plane(painted::nebula(320, 200)), on_plane(painted::nebula(100, 60))};
    const double before = sum_of(meshes[0].textures[0].image) / (320.0 * 200.0);
    reduce_to(meshes, 0, "gas");
    EXPECT_EQ(largest_picture(meshes), 320 * 200);
    reduce_to(meshes, 160 * 100, "gas");
    EXPECT_EQ(largest_picture(meshes), 160 * 100);
    EXPECT_EQ(meshes[1].textures[0].image.width, 100);
    EXPECT_NEAR(sum_of(meshes[0].textures[0].image) / (160.0 * 100.0), before, 0.003 * before);
    reduce_to(meshes, 15'000, "gas");
    EXPECT_NEAR(double(largest_picture(meshes)), 15'000.0, 150.0);
}

TEST(Bodies, SmallPicturesAreEnlargedUpToThoseOf2048x2048) {
    std::vector<TexturedMesh> meshes;
    for (const auto& [width, height] : {std::pair{300, 200}, {700, 500}, {1024, 1024}, {1024, 1025}})
        meshes.push_back(on_plane(make_image(width, height, 4, 0.5f)));
    enlarge_small_pictures(meshes, "gas");
    EXPECT_EQ(meshes[0].textures[0].image.width, 1200);
    EXPECT_EQ(meshes[1].textures[0].image.width, 2100);
    EXPECT_EQ(meshes[2].textures[0].image.width, 2048);
    EXPECT_EQ(meshes[3].textures[0].image.width, 1024);
    EXPECT_EQ(meshes[1].textures[0].image.height, 1500);
}

TEST(Bodies, TellHowFarTheyAre) {
    std::vector<double> told;
    const Progress progress{[&](double fraction) { told.push_back(fraction); }, nullptr};
    set_thread_count(1);  // several tell it in any order
    make_bodies({on_plane(painted::nebula(200, 120)), on_plane(painted::nebula(100, 60))},
                of_kind(StructureKind::sheet), 3u, "gas", progress);
    set_thread_count(0);
    EXPECT_TRUE(std::ranges::is_sorted(told));
    ASSERT_GT(told.size(), 20u);
    EXPECT_LT(told.front(), 0.1);
    EXPECT_DOUBLE_EQ(told.back(), 1.0);
    double widest = 0.0;
    for (std::size_t i = 1; i < told.size(); ++i) widest = std::max(widest, told[i] - told[i - 1]);
    EXPECT_LT(widest, 0.15);
}

TEST(UvSurface, ThePlaneIsThePicture) {
    const Mesh plane = builtin_mesh("plane", 1.6);
    const UvSurface surface(plane, 0, 1600, 1000, false);
    EXPECT_TRUE(surface.flat());
    EXPECT_NEAR(surface.texels_per_unit(), 160.0, 1e-6);
    const auto middle = places(surface, {0.5f, 0.5f});  // on the diagonal of its two triangles: once
    ASSERT_EQ(middle.size(), 1u);
    EXPECT_NEAR(glm::length(middle[0].position), 0.0, 1e-5);
    EXPECT_EQ(middle[0].normal, glm::vec3(0, 1, 0));
    EXPECT_NEAR(middle[0].units_per_texel, 1.0 / 160.0, 1e-8);
    const auto corner = places(surface, {0.001f, 0.999f});  // top left of the picture
    ASSERT_EQ(corner.size(), 1u);
    EXPECT_NEAR(corner[0].position.x, -4.99, 1e-3);
    EXPECT_NEAR(corner[0].position.z, -3.11875, 1e-3);
    EXPECT_TRUE(places(surface, {1.2f, 0.5f}).empty());
}

TEST(UvSurface, EveryPlaceOfASphereIsOnItOnce) {
    const Mesh sphere = builtin_mesh("sphere", 2.0);
    const UvSurface surface(sphere, 0, 2000, 1000, false);
    EXPECT_FALSE(surface.flat());
    for (int i = 0; i < 400; ++i) {
        const glm::vec2 uv(float(painted::random(std::uint32_t(i), 1)),
                           0.02f + 0.96f * float(painted::random(std::uint32_t(i), 2)));
        const auto found = places(surface, uv);
        ASSERT_EQ(found.size(), 1u) << uv.x << " " << uv.y;
        EXPECT_NEAR(glm::length(found[0].position), 5.0, 0.05);
        EXPECT_GT(glm::dot(found[0].normal, found[0].position), 4.9f);
    }
}

// Two faces under the same part of the picture, and a picture that goes on beyond its edges.
TEST(UvSurface, OverlapsAndRepetitionsAreAllVisited) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 5}, {1, 0, 5}, {0, 1, 5}};
    mesh.uvs = {{0, 0}, {1, 0}, {0, 1}};
    mesh.triangles = {{{0, 1, 2}, {0, 1, 2}}, {{3, 4, 5}, {0, 1, 2}}};
    const auto both = places(UvSurface(mesh, 0, 100, 100, false), {0.25f, 0.25f});
    ASSERT_EQ(both.size(), 2u);
    EXPECT_EQ(both[0].position.z, 0.0f);
    EXPECT_EQ(both[1].position.z, 5.0f);
    mesh.triangles.resize(1);
    mesh.uvs = {{0, 0}, {2, 0}, {0, 2}};  // the picture twice along each side
    EXPECT_EQ(places(UvSurface(mesh, 0, 100, 100, true), {0.25f, 0.25f}).size(), 3u);
    EXPECT_EQ(places(UvSurface(mesh, 0, 100, 100, false), {0.25f, 0.25f}).size(), 1u);
}

// Looks at a plane of 16 x 10 texels from the side of its edge.
TexturedMesh seen_obliquely(double parallel_height) {
    TexturedMesh mesh = on_plane(painted::nebula(160, 100));
    UvCamera params;
    params.position = glm::dvec3(1.0, 9.0, 6.0);
    params.fov = 50.0;
    params.height = parallel_height;
    mesh.camera = picture_camera(params, 1.6);
    apply_camera_uv(mesh.mesh, *mesh.camera);
    return mesh;
}

TEST(UvSurface, APlaceSeenByACameraIsOnItsRay) {
    for (const double parallel_height : {0.0, 4.0}) {
        const TexturedMesh mesh = seen_obliquely(parallel_height);
        const Camera& camera = *mesh.camera;
        const UvSurface surface(mesh.mesh, 0, 160, 100, false, &camera);
        for (const glm::vec2 uv : {glm::vec2(0.5f, 0.5f), {0.4f, 0.6f}, {0.61f, 0.43f}}) {
            const auto found = places(surface, uv);
            ASSERT_EQ(found.size(), 1u);
            EXPECT_NEAR(found[0].position.y, 0.0f, 1e-5f);
            for (const float texels : {0.0f, 20.0f, -30.0f}) {
                const float z = texels * found[0].units_per_texel;
                const auto seen = place_in_picture(camera, glm::dvec3(found[0].position + found[0].rise * z));
                ASSERT_TRUE(seen);
                EXPECT_LT(glm::distance(seen->uv, glm::dvec2(uv)), 1e-6);
                EXPECT_NEAR(seen->depth, double(found[0].depth - z), 1e-5);
                // A texel there covers a hundredth of the picture's height.
                const double scale = double(found[0].units_per_texel * (1.0f - found[0].approach * texels));
                EXPECT_NEAR(100.0 * scale, picture_height_at(camera, seen->depth), 1e-5);
            }
        }
    }
}

TEST(UvSurface, ACameraSeesTheNearestFace) {
    TexturedMesh mesh;
    mesh.mesh = builtin_mesh("sphere", 1.0);
    UvCamera params;
    params.position = glm::dvec3(0.0, 0.0, 20.0);
    mesh.camera = picture_camera(params, 1.0);
    apply_camera_uv(mesh.mesh, *mesh.camera);
    const auto found =
        places(UvSurface(mesh.mesh, 0, 100, 100, false, &*mesh.camera), glm::vec2(0.52f, 0.47f));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_GT(found[0].position.z, 4.8f);
}

// The camera sees the set as the fit saw it: every splat where it is in the picture, and as large.
TEST(Bodies, KeepTheirPlaceInThePictureOfTheirCamera) {
    TexturedMesh front = on_plane(painted::nebula(160, 100));
    const SplatSet plain = make_bodies({front}, of_kind(StructureKind::sheet), 3u, "gas");
    UvCamera params;
    params.position = glm::dvec3(0.0, 8.0, 0.0);
    params.up = glm::dvec3(0.0, 0.0, -1.0);
    params.fov = 2.0 * real::degrees(real::atan2(3.125, 8.0));
    front.camera = picture_camera(params, 1.6);
    apply_camera_uv(front.mesh, *front.camera);
    const SplatSet seen = make_bodies({front}, of_kind(StructureKind::sheet), 3u, "gas");
    ASSERT_GT(seen.size(), plain.size() * 99 / 100);  // uv that is rounded loses some at the edges
    std::size_t k = 0;
    for (std::size_t i = 0; i < seen.id.size(); ++i) {
        while (plain.id[k] < seen.id[i]) ++k;
        ASSERT_EQ(plain.id[k], seen.id[i]);
        const glm::vec3 p = plain.position[k];  // the picture's plane is 8 from the camera
        const auto place = place_in_picture(*front.camera, glm::dvec3(seen.position[i]));
        ASSERT_TRUE(place);
        ASSERT_NEAR(place->uv.x, 0.5 + double(p.x) / 10.0, 2e-6);
        ASSERT_NEAR(place->uv.y, 0.5 - double(p.z) / 6.25, 2e-6);
        const auto y = double(p.y);  // what is plane stays plane where rays meet
        ASSERT_NEAR(place->depth, 8.0 - y / (1.0 + y / 8.0), 2e-5);
        ASSERT_NEAR(seen.radius[i], plain.radius[k] * float(place->depth) / 8.0f, 1e-5f);
        ASSERT_EQ(seen.color[i], plain.color[k]);
    }
}

TEST(Opacity, FollowsBrightnessAndNeverExceedsThePicturesAlpha) {
    const Opacity opacity{0.5f, 0.8f};
    EXPECT_NEAR(1.0 - std::exp(-double(opacity.depth_of(1.0f, 1.0f))), 0.8, 1e-6);
    EXPECT_NEAR(1.0 - std::exp(-double(opacity.depth_of(0.25f, 1.0f))), 0.4, 1e-6);
    EXPECT_NEAR(1.0 - std::exp(-double(opacity.depth_of(0.25f, 0.1f))), 0.1, 1e-6);
    EXPECT_NEAR(1.0 - std::exp(-double(opacity.depth_of(100.0f, 1.0f))), 0.985, 1e-6);
    EXPECT_EQ(opacity.depth_of(0.0f, 1.0f), 0.0f);
}

TEST(PictureLight, FadesAtTheBorderAndDropsWhatIsNoLight) {
    Image rgb = make_image(100, 60, 3, 0.5f);
    rgb.at(50, 30)[0] = -1.0f;
    rgb.at(51, 30)[0] = std::nanf("");
    const PictureLight plain = picture_light(as_texture(rgb), 0.0);
    EXPECT_TRUE(plain.alpha.pixels.empty());
    EXPECT_EQ(plain.light.at(50, 30)[0], 0.0f);
    EXPECT_EQ(plain.light.at(51, 30)[0], 0.0f);
    EXPECT_EQ(plain.light.at(0, 0)[1], 0.5f);
    const PictureLight faded = picture_light(as_texture(rgb), 0.1);
    EXPECT_LT(faded.light.at(0, 30)[1], 0.01f);
    EXPECT_EQ(faded.light.at(10, 30)[1], 0.5f);
    EXPECT_NEAR(faded.light.at(4, 30)[1] / 0.5f, *faded.alpha.at(4, 30), 1e-6);
}

struct Fitted {
    PictureSplats set;
    FrontFit fit;
};
Fitted fitted(const Image& light, StructureKind kind, double texels_per_unit, bool enlarged = false) {
    const Image brightest = brightest_channel(light);
    const Placement placement = make_placement(brightest, of_kind(kind), texels_per_unit, true, 1u);
    Fitted result;
    const std::vector<Band> bands = make_bands(light.width);
    split_bands(light, bands, false, [&](const Band& band, const Image& image) {
        const bool coarsest = band.index + 1 == int(bands.size());
        for (const BandSplats& size : band_splats(band, coarsest, placement))
            add_band(whole_band(image), size, brightest, {}, placement, {}, result.set);
    });
    result.fit = fit_front(result.set, light, enlarged);
    return result;
}

// The fit makes an even picture even and keeps its flux.
TEST(FrontFit, GivesAnEvenPictureItsColour) {
    Image light = make_image(96, 64, 3);
    for (std::size_t i = 0; i < light.pixels.size(); ++i)
        light.pixels[i] = i % 3 == 0 ? 0.4f : i % 3 == 1 ? 0.2f : 0.1f;
    EXPECT_GT(fitted(light, StructureKind::disk, 10.0).fit.psnr_db, 30.0);
}

// Steps that take nothing of the last one along end 1 dB below.
TEST(FrontFit, IsCloseToItsPictureAfterSevenSteps) {
    Image light = painted::nebula(480, 300);
    for (std::size_t i = 0; i < light.pixels.size(); ++i)
        light.pixels[i] *= float(0.5 + painted::random(std::uint32_t(i), 7));
    const FrontFit fit = fitted(light, StructureKind::sheet, 48.0).fit;
    EXPECT_EQ(fit.steps, 7);
    EXPECT_GT(fit.psnr_db, 44.0);
}

TEST(FrontFit, TakesMoreStepsWhereThereIsDust) {
    const Image light = painted::nebula(96, 64);
    PictureSplats set = fitted(light, StructureKind::disk, 10.0).set;
    EXPECT_EQ(fit_front(set, light).steps, 7);
    set.absorbs = true;
    EXPECT_EQ(fit_front(set, light).steps, 10);
}

Image view_along_z(const PictureSplats& set, const Image& light, double from) {
    RenderLayer layer;
    layer.splats = &set.splats;
    CameraParams params;
    params.projection = Projection::orthographic;
    params.position = glm::dvec3(0.0, 0.0, from);
    params.target = glm::dvec3(0.0);
    params.height = double(light.height);
    RenderSettings settings;
    settings.width = light.width;
    settings.height = light.height;
    const Camera camera = make_camera(params, double(light.width), double(light.height), {});
    return render({&layer, 1}, camera, nullptr, settings).beauty;
}

/// Share of the green light that is seen, away from the edges.
double share_seen(const Image& seen, const Image& light, std::int64_t margin = 0) {
    double here = 0.0, there = 0.0;
    for (std::int64_t y = margin; y < light.height - margin; ++y)
        for (std::int64_t x = margin; x < light.width - margin; ++x) {
            here += double(seen.at(x, y)[1]);
            there += double(light.at(x, y)[1]);
        }
    return here / there;
}

// The steps of the fit leave some .1 % too much here, which cells of 32 px take away.
TEST(FrontFit, KeepsThePicturesFlux) {
    const Image light = painted::galaxy(320, 192);
    const PictureSplats set = fitted(light, StructureKind::disk, 32.0).set;
    EXPECT_NEAR(share_seen(view_along_z(set, light, 1000.0), light, 32), 1.0, 0.0005);
}

// It is rendered on pixels of two texels.
TEST(FrontFit, OfALargePictureIsAsClose) {
    const Image light = painted::galaxy(1301, 811);
    const PictureSplats set = fitted(light, StructureKind::disk, 130.0).set;
    const Image seen = view_along_z(set, light, 3000.0), wanted = gaussian_blur(light, 0.5);
    double squares = 0.0;
    for (std::int64_t y = 0; y < light.height; ++y)
        for (std::int64_t x = 0; x < light.width; ++x) {
            const double difference =
                double(display_srgb(seen.at(x, y)[1])) - double(display_srgb(wanted.at(x, y)[1]));
            squares += difference * difference;
        }
    EXPECT_NEAR(share_seen(seen, wanted), 1.0, 0.001);
    EXPECT_GT(-10.0 * std::log10(squares / double(light.width * light.height)), 44.0);
}

// Seen on pixels of two texels, crowded points hide less of themselves: fitted so, their light is 1.3
// % too little.
TEST(FrontFit, OfASmallPictureHasTheLightOfItsPoints) {
    Image points = make_image(560, 480, 3, 0.01f);
    for (std::uint32_t i = 0; i < 20000; ++i) {
        const double light = 0.8 * std::pow(painted::random(i, 3), 6.0);
        painted::add_point(points, 560.0 * painted::random(i, 1), 480.0 * painted::random(i, 2), 0.8, light,
                           light, light);
    }
    const Image light = enlarged(points, 2);
    const PictureSplats set = fitted(light, StructureKind::sheet, 112.0, true).set;
    EXPECT_NEAR(share_seen(view_along_z(set, light, 3000.0), light), 1.0, 0.001);
}

// Light that the back wall loses in the glow before it is not given back many times over.
TEST(FrontFit, WallsHaveTheSameLightFromBehind) {
    Image light = painted::remnant(480, 300);
    for (float& value : light.pixels) value *= 4.0f;
    const PictureSplats set = fitted(light, StructureKind::walls, 48.0).set;
    const Image front = view_along_z(set, light, 1000.0), back = view_along_z(set, light, -1000.0);
    double squares = 0.0;
    for (std::int64_t y = 0; y < light.height; ++y)
        for (std::int64_t x = 0; x < light.width; ++x) {
            const double difference = double(display_srgb(front.at(x, y)[0])) -
                                      double(display_srgb(back.at(light.width - 1 - x, y)[0]));
            squares += difference * difference;
        }
    EXPECT_LT(std::sqrt(squares / double(light.width * light.height)), 0.014);
}

class EveryStructure : public testing::TestWithParam<StructureKind> {};
INSTANTIATE_TEST_SUITE_P(Bodies, EveryStructure,
                         testing::Values(StructureKind::disk, StructureKind::sheet, StructureKind::walls,
                                         StructureKind::axis),
                         [](const auto& kind) { return std::string(name_of(kind.param)); });

Image painted_for(StructureKind kind, std::int64_t width, std::int64_t height) {
    if (kind == StructureKind::disk) return painted::galaxy(width, height);
    return kind == StructureKind::sheet ? painted::nebula(width, height) : painted::remnant(width, height);
}

TEST_P(EveryStructure, MakesAWholeSet) {
    const TexturedMesh mesh = on_plane(painted_for(GetParam(), 320, 200));
    const SplatSet set = make_bodies({mesh}, of_kind(GetParam()), 3u, "gas");
    check_consistent(set);
    ASSERT_GT(set.size(), 30000);
    EXPECT_EQ(set.spacing, glm::dvec3(0.0));
    double farthest = 0.0;
    for (std::size_t i = 0; i < set.id.size(); ++i) {
        if (i > 0) {
            ASSERT_LT(set.id[i - 1], set.id[i]);
        }
        ASSERT_TRUE(std::isfinite(set.position[i].y));
        ASSERT_LE(std::fabs(set.position[i].x), 5.001f);
        ASSERT_LE(std::fabs(set.position[i].z), 3.126f);
        ASSERT_LT(std::fabs(set.position[i].y), GetParam() == StructureKind::axis ? 5.0f : 2.5f);
        ASSERT_GT(set.alpha[i], 0.0f);
        ASSERT_LE(set.alpha[i], 1.0f);
        const bool dust = (set.id[i] >> 48 & 255) == 254;
        ASSERT_EQ(set.color[i].x < 0.0f, dust);
        ASSERT_GT(set.radius[i], 0.0f);
        ASSERT_EQ(set.normal[i], glm::vec3(0, 1, 0));
        farthest = std::max(farthest, double(set.distance[i]));
    }
    EXPECT_EQ(set.max_distance, farthest);
    EXPECT_EQ(set.absorbs, GetParam() == StructureKind::disk);
}

TEST(Bodies, EveryKeyCounts) {
    const TexturedMesh mesh = on_plane(painted::nebula(160, 100));
    const auto changed = [&](void (*change)(StructureParams&)) {
        StructureParams params = of_kind(StructureKind::sheet);
        change(params);
        return make_bodies({mesh}, params, 3u, "gas");
    };
    const SplatSet usual = changed([](StructureParams&) {});
    void (*const of_positions[])(StructureParams&) = {
        [](StructureParams& p) { p.height = 0.3; }, [](StructureParams& p) { p.depth = 0.3; },
        [](StructureParams& p) { p.clumps = 0.3; }, [](StructureParams& p) { p.border = 0.2; },
        [](StructureParams& p) { p.stars = StructureParams::Stars::no; }};
    for (const auto change : of_positions) EXPECT_FALSE(changed(change).position == usual.position);
    EXPECT_FALSE(changed([](StructureParams& p) { p.opacity = 0.9; }).alpha == usual.alpha);
    EXPECT_FALSE(changed([](StructureParams& p) { p.density = 0.3; }).alpha == usual.alpha);
}

/// The front of a plane's splats, `texels_per_unit` px a unit, so many px wide and high.
Image front_of(const SplatSet& set, double texels_per_unit, std::int64_t width, std::int64_t height) {
    ShadedSplats splats;
    splats.position = set.position;
    splats.color = set.color;
    splats.alpha = set.alpha;
    splats.radius = set.radius;
    splats.id = set.id;
    RenderLayer layer;
    layer.splats = &splats;
    CameraParams params;
    params.projection = Projection::orthographic;
    params.position = {0.0, 100.0, 0.0};
    params.target = glm::dvec3(0.0);
    params.up = {0.0, 0.0, -1.0};
    params.height = double(height) / texels_per_unit;
    RenderSettings settings;
    settings.width = width;
    settings.height = height;
    const Camera camera = make_camera(params, double(width), double(height), {});
    return render({&layer, 1}, camera, nullptr, settings).beauty;
}

/// Mean difference of green between two images, over the mean of the first.
double relative_difference(const Image& a, const Image& b) {
    double away = 0.0, all = 0.0;
    for_each_between(a, 0, 0, a.width, a.height, [&](std::int64_t x, std::int64_t y) {
        away += std::fabs(double(a.at(x, y)[1]) - double(b.at(x, y)[1]));
        all += double(a.at(x, y)[1]);
    });
    return away / all;
}

// From afar the picture, stars included; close by what the enlarged picture does not have, and another with
// another seed.
TEST(Bodies, DetailIsThePictureFromAfar) {
    constexpr std::int64_t width = 150, height = 90;
    constexpr int times = 4;
    Image picture = painted::nebula(width, height);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        picture.pixels[i] *= float(0.85 + 0.3 * painted::random(std::uint32_t(i / 3), 7));
    const auto seen = [&](int detail, std::uint32_t seed, double margin) {
        std::vector<TexturedMesh> meshes{on_plane(picture)};
        if (detail == 0) enlarge_small_pictures(meshes, "gas");
        StructureParams params = of_kind(StructureKind::sheet);
        params.detail = detail;
        params.margin = margin;
        add_margins(meshes, params, "gas");
        return front_of(make_bodies(std::move(meshes), params, seed, "gas"), 0.1 * times * width,
                        times * width, times * height);
    };
    const Image even = seen(0, 3u, 0.0), detailed = seen(2, 3u, 0.0);
    EXPECT_GT(relative_difference(even, detailed), 0.05);
    EXPECT_GT(relative_difference(seen(2, 4u, 0.0), detailed), 0.03);
    const auto texels = [&](const Image& image) { return reduced_by_area(image, width, height); };
    EXPECT_LT(relative_difference(texels(even), texels(detailed)), 0.02);
    EXPECT_LT(relative_difference(picture, texels(detailed)),
              2.0 * relative_difference(picture, texels(even)));
    // A margin of 98 px, no whole number of texels, parts none of them.
    EXPECT_LT(relative_difference(texels(seen(0, 3u, 0.1625)), texels(seen(2, 3u, 0.1625))), 0.02);
}

// Tiles of detail change what is in them alone: all else has the same splats at the same places.
TEST(Bodies, DetailLiesInItsTiles) {
    const TexturedMesh mesh = on_plane(painted::nebula(320, 198));
    StructureParams params = of_kind(StructureKind::sheet);
    params.stars = StructureParams::Stars::no;
    const SplatSet plain = make_bodies({mesh}, params, 3u, "gas");
    params.detail = 2;
    params.detail_tiles = "0000 0120 0000";
    const SplatSet tiled = make_bodies({mesh}, params, 3u, "gas");
    const auto places = [](const SplatSet& set, bool detail) {
        std::map<std::uint64_t, std::pair<glm::vec3, glm::vec2>> all;
        for (std::size_t i = 0; i < set.id.size(); ++i)
            if (((set.id[i] >> 48 & 255) >= 128) == detail) all[set.id[i]] = {set.position[i], set.uv[i]};
        return all;
    };
    const auto before = places(plain, false), after = places(tiled, false), detail = places(tiled, true);
    const auto in_tiles = [](const glm::vec2& uv) {
        return uv.x >= 0.25f && uv.x < 0.75f && uv.y > 1.0f / 3.0f && uv.y < 2.0f / 3.0f;
    };
    std::size_t finest = 0;
    for (const auto& [id, place] : before) {
        const bool inside = in_tiles(place.second), is_finest = (id >> 48 & 255) == 0;
        finest += inside && is_finest ? 1 : 0;
        ASSERT_FALSE(inside && is_finest && after.contains(id));
        ASSERT_TRUE(inside || (after.contains(id) && after.at(id).first == place.first));
    }
    for (const auto& [id, place] : after) ASSERT_TRUE(before.contains(id));
    EXPECT_GT(detail.size(), 8 * finest);
    for (const auto& [id, place] : detail) ASSERT_TRUE(in_tiles(place.second)) << place.second.x;
    test::expect_same_bits([&] {
        const SplatSet set = make_bodies({mesh}, params, 3u, "gas");
        return test::Bits() << set.position << set.color << set.alpha;
    });
}

// Light that fades towards the border is darker than what is around it, as dust would be.
TEST(Bodies, AFadingBorderIsNoDust) {
    const auto hidden = [](double border) {
        StructureParams params = of_kind(StructureKind::disk);
        params.border = border;
        params.dust = 1.0;
        const TexturedMesh mesh = on_plane(make_image(320, 200, 3, 0.3f));
        const SplatSet set = make_bodies({mesh}, params, 1u, "even");
        double sum = 0.0, most = 0.0;
        for (std::size_t i = 0; i < set.color.size(); ++i) {
            if (set.color[i].x >= 0.0f) continue;
            sum += double(set.alpha[i]);
            most = std::max(most, double(set.alpha[i]));
        }
        return std::pair(sum, most);
    };
    EXPECT_LT(hidden(0.0).first, 1.0);
    EXPECT_LT(hidden(0.1).second, 0.2);
}

// The plane of a warped disk rises on one side as it sinks on the other, and not in the middle; a flared one
// is thicker at its rim by as much as was asked for.
TEST(Bodies, DisksWarpAndFlare) {
    const Image even = make_image(300, 200, 1, 0.3f);
    const auto of_disk = [&](double flare, double warp) {
        StructureParams params = of_kind(StructureKind::disk);
        params.flare = flare;
        params.warp = warp;
        return make_placement(even, params, 30.0, true, 1u);
    };
    const Placement plain = of_disk(0.0, 0.0), bent = of_disk(0.5, 0.1);
    EXPECT_EQ(middle_plane(plain, 299.0f, 100.0f), 0.0f);
    EXPECT_EQ(middle_plane(bent, 150.0f, 100.0f), 0.0f);
    EXPECT_EQ(middle_plane(bent, 200.0f, 100.0f), 0.0f);  // nearer than .4 of 150
    EXPECT_NEAR(middle_plane(bent, 300.0f, 100.0f), 0.1f * 300.0f * 0.866f, 1e-3f);
    EXPECT_NEAR(middle_plane(bent, 0.0f, 100.0f), -0.1f * 300.0f * 0.866f, 1e-3f);
    const auto disk = [](const Placement& p) { return p.galaxies[0].parts[std::size_t(GalaxyPart::disk)]; };
    for (std::size_t k = 0; k < disk(plain).size(); ++k) {
        // Where it is what is seen: at three times its width from the middle, in halves of the picture's.
        const double width = std::sqrt(0.5 / double(disk(plain)[k].u2)), out = std::min(1.0, width / 100.0);
        EXPECT_NEAR(disk(bent)[k].deviation / disk(plain)[k].deviation, 1.0 + 0.5 * out * out, 1e-3);
    }
}

// Every splat rises with the plane where it is, but for those of a knot, which rises as a whole.
TEST(Bodies, AWarpMovesSplatsStarsAndDustAlike) {
    const TexturedMesh mesh = on_plane(painted::galaxy(320, 200));
    StructureParams params = of_kind(StructureKind::disk);
    const SplatSet flat = make_bodies({mesh}, params, 3u, "gas");
    params.warp = 0.08;
    const SplatSet bent = make_bodies({mesh}, params, 3u, "gas");
    const Placement plane = make_placement(make_image(320, 200, 1, 0.3f), params, 32.0, true, 1u);
    int all[3] = {0, 0, 0}, exact[3] = {0, 0, 0};  // shining, dust, stars
    std::size_t k = 0;
    for (std::size_t i = 0; i < flat.id.size(); ++i) {
        while (k < bent.id.size() && bent.id[k] < flat.id[i]) ++k;
        if (k == bent.id.size() || bent.id[k] != flat.id[i]) continue;  // dust may be thinned otherwise
        const glm::vec3 p = flat.position[i];
        const float rise = middle_plane(plane, 32.0f * p.x + 160.0f, 100.0f + 32.0f * p.z) / 32.0f;
        if (std::fabs(rise) < 0.1f) continue;
        const std::uint64_t band = flat.id[i] >> 48 & 255;
        const int kind = band == 254 ? 1 : band == 255 ? 2 : 0;
        const float off = std::fabs(bent.position[k].y - p.y - rise);
        ASSERT_LT(off, 0.4f);
        ++all[kind];
        exact[kind] += off < 1e-4f;
    }
    EXPECT_GT(all[0], 1000);
    EXPECT_GT(exact[0], 0.6 * all[0]);
    EXPECT_GT(all[1], 10);
    EXPECT_EQ(exact[1], all[1]);
    EXPECT_GT(all[2], 5);
    EXPECT_EQ(exact[2], all[2]);
}

TEST(Bodies, WhereThePictureIsTransparentThereIsNothing) {
    TexturedMesh mesh = on_plane(painted::nebula(160, 100));
    Image& image = mesh.textures[0].image;
    for (std::int64_t y = 0; y < 100; ++y)
        for (std::int64_t x = 0; x < 80; ++x) std::fill_n(image.at(x, y), 4, 0.0f);
    const SplatSet set = make_bodies({mesh}, of_kind(StructureKind::sheet), 3u, "gas");
    ASSERT_GT(set.size(), 1000);
    for (const glm::vec3& p : set.position) ASSERT_GT(p.x, -0.1f);
}

TEST(Bodies, EveryMeshShowsItsOwnPicture) {
    std::vector<TexturedMesh> meshes{on_plane(make_image(64, 64, 3, 0.2f)),
                                     on_plane(make_image(64, 64, 3, 0.4f))};
    for (glm::vec3& p : meshes[1].mesh.positions) p.y += 7.0f;
    const SplatSet set = make_bodies(meshes, of_kind(StructureKind::disk), 3u, "gas");
    int upper = 0;
    for (std::size_t i = 0; i < set.id.size(); ++i) {
        ASSERT_EQ(set.mesh[i] == 1, set.position[i].y > 3.5f);
        upper += set.mesh[i] == 1;
    }
    EXPECT_GT(upper, 1000);
    EXPECT_LT(upper, set.size() - 1000);
}

}  // namespace
}  // namespace astrosplat
