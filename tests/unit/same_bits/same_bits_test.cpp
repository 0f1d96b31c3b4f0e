// Every function that shares its work among threads or has kernels for several instruction sets: the same
// bits however many threads and whichever instructions. A new one adds its row. What needs a frame, a look or
// a file of errors to show it does so in its own tests.
#include "bodies/bodies.h"
#include "bodies/front_fit.h"
#include "bodies/galaxy_fit.h"
#include "bodies/margin.h"
#include "bodies/picture_light.h"
#include "bodies/stars.h"
#include "fidelity/front.h"
#include "generate/generate.h"
#include "image/blur.h"
#include "image/channels.h"
#include "image/resample.h"
#include "output/write.h"
#include "prepare/stages.h"
#include "prepare/star_removal.h"
#include "scene/front_frame.h"
#include "source/tiled_sky.h"
#include "splat_files/formats.h"
#include "splat_files/native.h"
#include "splats/row_order.h"
#include "stars/star_set.h"
#include "support/painted_picture.h"
#include "support/test.h"
#include "volumes/voxel_grid.h"

namespace astrosplat {

test::Bits operator<<(test::Bits bits, const SplatSet& set) {
    return bits << set.position << set.color << set.alpha << set.distance << set.id << set.uv << set.normal
                << set.mesh << set.radius;
}

namespace {

using test::Bits;

const Image& galaxy() {
    static const Image image = painted::galaxy(240, 150);
    return image;
}

/// A plane or a ball that shows the galaxy.
std::vector<TexturedMesh> lit(const char* shape) {
    std::vector<TexturedMesh> meshes(1);
    meshes[0].mesh = builtin_mesh(shape, 1.6);
    Texture& texture = meshes[0].textures.emplace_back();
    texture.alpha_from_light = true;
    texture.image = make_image(galaxy().width, galaxy().height, 4, 0.2f);
    for (std::int64_t i = 0; i < galaxy().width * galaxy().height; ++i)
        std::copy_n(galaxy().pixels.data() + 3 * i, 3, texture.image.pixels.data() + 4 * i);
    return meshes;
}

SplatSet generated() {
    SourceParams source;
    source.voxels = glm::i64vec3(45, 36, 41);  // whole and broken blocks
    const std::vector<TexturedMesh> meshes = lit("sphere");
    return generate(meshes, make_lattice(source, meshes, 0.6), 0.6, 1.0, 5);
}

Bits bodies_of(StructureKind kind) {
    StructureParams params;
    params.kind = kind;
    return Bits() << make_bodies(lit("plane"), params, 3u, "gas");
}

Bits filled() {
    Image image = galaxy();
    PixelMask holes = make_mask(image.width, image.height);
    for (std::int64_t i = 0; i < 1200; ++i) holes.at(i * 37 % image.width, i * 53 % image.height) = 1;
    fill(image, holes, FillKind::texture);
    return Bits() << image;
}

Bits stars_removed() {
    const StarRemoval removal = remove_stars(galaxy(), {});
    return Bits() << removal.starless << star_table(removal.stars, galaxy().width, galaxy().height);
}

/// The rest of the picture, and what was taken of it.
template <class Take>
Bits taken(Image light, const Take& take) {
    const std::vector<Star> stars = take(light);
    EXPECT_GT(stars.size(), 10u);
    Bits bits;
    for (const Star& star : stars)
        bits << star.x << star.y << star.sigma << star.peak.x << star.peak.y << star.peak.z;
    return bits << light;
}

/// With twelve stars more, burnt out at 1.
Image with_bright_stars() {
    Image image = painted::galaxy(480, 300);
    for (std::uint32_t i = 0; i < 12; ++i)
        painted::add_point(image, 30.0 + 420.0 * painted::random(i, 51),
                           30.0 + 240.0 * painted::random(i, 52), 1.5 + painted::random(i, 53), 3, 3, 2);
    for (float& value : image.pixels) value = std::min(value, 1.0f);
    return image;
}

Bits bands() {
    std::vector<Image> images;
    split_bands(galaxy(), make_bands(galaxy().width), false,
                [&](const Band&, const Image& image) { images.push_back(image); });
    return Bits() << images;
}

/// Splats of three sizes and one of dust.
Bits flat_light() {
    PictureSplats set;
    std::uint32_t n = 0;
    for (const float sigma : {0.5f, 1.7f, 6.0f}) {
        const auto begin = set.splats.size();
        for (int i = 0; i < 300; ++i, ++n) {
            set.splats.position.emplace_back(96.0f * (float(painted::random(n, 1)) - 0.5f),
                                             31.9f - 0.21f * float(i), 0.0f);
            set.splats.color.emplace_back(1.0f, 0.5f, float(painted::random(n, 2)));
            set.splats.alpha.push_back(0.1f);
            set.splats.radius.push_back(radius_sigmas * sigma);
        }
        set.ranges.push_back({begin, set.splats.size(), sigma});
    }
    set.splats.position.emplace_back(0.0f);
    set.splats.color.emplace_back(-1.0f);
    set.splats.alpha.push_back(0.5f);
    set.splats.radius.push_back(4.0f);
    return Bits() << FlatLight(set, 96, 64, 0.5).sum();
}

Bits margins() {
    std::vector<TexturedMesh> meshes = lit("plane");
    StructureParams params;
    params.kind = StructureKind::disk;
    params.margin = 0.1;
    add_margins(meshes, params, "gas");
    return Bits() << meshes[0].textures[0].image;
}

Bits galaxy_fit() {
    const Image light = painted::tilted_galaxy(120, 75, {70.0, 33.0});
    const GalaxyFit fit = fit_galaxies(light, Galaxies::one).front();
    return Bits() << fit.plane.inclination_deg << fit.plane.angle << fit.misfit << fit.bulge;
}

Bits fidelity() {
    const FrontFidelity f = front_fidelity(gaussian_blur(galaxy(), 1.0), galaxy());
    Bits bits;
    bits << f.psnr_db << f.ssim << f.flux.frame << f.flux.cells << f.ciede2000.median;
    for (const ScalePower& scale : f.power) bits << scale.ratio;
    return bits;
}

Bits sky() {
    Bits bits;
    for (const Image& face : tiled_sky(galaxy(), {60.0, 1, 64})) bits << face;
    return bits;
}

Bits voxels() {
    std::vector<VoxelSplat> splats(400);
    for (int i = 0; i < 400; ++i) {
        const double variance = std::pow(0.02 + 0.0002 * i, 2.0);
        VoxelSplat& splat = splats[std::size_t(i)];
        splat.place = {std::sin(i * 1.7), std::cos(i * 0.9), std::sin(i * 0.3)};
        splat.ray = {0.0f, 0.0f, -1.0f};
        splat.covariance = {variance, i % 9 == 0 ? 400.0 * variance : variance, variance, 0.0, 0.0, 0.0};
        splat.shows = splat.hides = 0.002f * float(i);
        splat.light = {0.001f * float(i), 0.1f, 0.2f};
    }
    const VoxelGrid grid = fill_voxels(splats, 0.03);
    return Bits() << grid.blocks << grid.density << grid.emission << grid.color << grid.density_put;
}

Bits random_star_set() {
    return Bits() << random_stars({{{0, 0, 0}, {20, 3, 0}, {9, 9, 9}}, 4.0}, main_sequence(), 10000, 3, {});
}

Bits front() {
    const std::vector<TexturedMesh> ball = lit("sphere");
    return Bits() << front_picture(ball, front_frame(ball));
}

/// The bytes of the file that `write` writes to a path of that ending.
template <class Write>
Bits file(const std::string& ending, const Write& write) {
    const TempFolder folder;
    write(folder / ("file." + ending));
    return Bits() << test::bytes_of(folder / ("file." + ending));
}

const SplatSet& stored_set() {
    static const SplatSet set = generated();
    return set;
}

Bits frame(const std::string& ending) {
    RenderedFrame frame;
    frame.beauty = make_image(200, 300, 4);
    for (std::size_t i = 0; i < frame.beauty.pixels.size(); ++i)
        frame.beauty.pixels[i] = float(i * 7919 % 1009) / 1009.0f;
    frame.depth = make_image(200, 300, 1, 123.456f);
    frame.layers = {frame.beauty, make_image(200, 300, 4, 0.25f)};
    FrameFile target{{}, {}, 200, 300, {}, {"gas", "dust"}};
    if (ending == "exr") target.output.aovs = {"layers", "depth"};
    return file(ending, [&](const auto& path) {
        target.file = path;
        write_frame(target, frame, {});
    });
}

const std::map<std::string, std::function<Bits()>> functions = {
    {"gaussian_blur", [] { return Bits() << gaussian_blur(galaxy(), 6.0); }},
    {"convolved_with_gaussian", [] { return Bits() << convolved_with_gaussian(galaxy(), 3.0); }},
    {"opened", [] { return Bits() << opened(brightest_channel(galaxy()), 7); }},
    {"reduced_by_area", [] { return Bits() << reduced_by_area(galaxy(), 101, 67); }},
    {"fill", filled},
    {"remove_stars", stars_removed},
    {"front_fidelity", fidelity},
    {"tiled_sky", sky},
    {"generate", [] { return Bits() << generated(); }},
    {"take_stars", [] { return taken(galaxy(), [](Image& light) { return take_stars(light); }); }},
    {"take_bright_stars",
     [] { return taken(with_bright_stars(), [](Image& light) { return take_bright_stars(light); }); }},
    {"split_bands", bands},
    {"flat_light", flat_light},
    {"add_margins", margins},
    {"fit_galaxies", galaxy_fit},
    {"bodies_of_a_disk", [] { return bodies_of(StructureKind::disk); }},
    {"bodies_of_a_sheet", [] { return bodies_of(StructureKind::sheet); }},
    {"bodies_of_walls", [] { return bodies_of(StructureKind::walls); }},
    {"bodies_about_an_axis", [] { return bodies_of(StructureKind::axis); }},
    {"random_stars", random_star_set},
    {"morton_order", [] { return Bits() << morton_order(stored_set()); }},
    {"fill_voxels", voxels},
    {"front_picture", front},
    {"write_pda", [] { return file("pda", [](const auto& path) { write_pda(path, stored_set()); }); }},
    {"write_ply", [] { return file("ply", [](const auto& path) { write_ply(path, stored_set()); }); }},
    {"write_native",
     [] { return file("splats", [](const auto& path) { write_native(path, stored_set()); }); }},
    {"write_exr", [] { return frame("exr"); }},
    {"write_tiff", [] { return frame("tif"); }},
    {"write_png", [] { return frame("png"); }},
};

class SameBits : public testing::TestWithParam<std::string> {};

TEST_P(SameBits, OnAnyThreadsAndInstructions) { test::expect_same_bits(functions.at(GetParam())); }

INSTANTIATE_TEST_SUITE_P(All, SameBits, testing::ValuesIn([] {
                             std::vector<std::string> names;
                             for (const auto& [name, run] : functions) names.push_back(name);
                             return names;
                         }()),
                         [](const auto& name) { return name.param; });

}  // namespace
}  // namespace astrosplat
