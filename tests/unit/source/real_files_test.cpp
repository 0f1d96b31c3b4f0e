// Published meshes, pictures and FITS files: what their makers say is in them.
#include "core/log.h"
#include "source/fits.h"
#include "source/mesh.h"
#include "source/picture.h"
#include "source/texture.h"
#include "support/test.h"
#include "support/test_data.h"

namespace astrosplat {
namespace {

using Wrap = TextureSettings::Wrap;

Texture load(const fs::path& file, const TextureSettings& settings = {}) {
    return load_texture({file}, settings, Wrap::clamp);
}

struct MeshFile {
    const char* path;
    std::size_t triangles;
    bool has_uv;
};

void PrintTo(const MeshFile& file, std::ostream* out) { *out << file.path; }

class RealMesh : public testing::TestWithParam<MeshFile> {};

TEST_P(RealMesh, HasItsTriangles) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(file, std::string("meshes/") + GetParam().path);
    const Said some_name_libraries_that_are_not_there;
    const Mesh mesh = load_obj(file);
    EXPECT_EQ(mesh.triangles.size(), GetParam().triangles);
    EXPECT_GT(surface_area(mesh), 0.0);
    for (const Mesh::Triangle& t : mesh.triangles) {
        ASSERT_LT(std::max({t.position[0], t.position[1], t.position[2]}), mesh.positions.size());
        ASSERT_EQ(t.uv[0] != Mesh::no_uv, GetParam().has_uv);
        ASSERT_TRUE(!GetParam().has_uv || std::max({t.uv[0], t.uv[1], t.uv[2]}) < mesh.uvs.size());
        ASSERT_TRUE(mesh.maps.empty() || t.material < mesh.maps.size());
    }
}

INSTANTIATE_TEST_SUITE_P(Files, RealMesh,
                         testing::Values(MeshFile{"trimesh/singlevn.obj", 2, true},
                                         MeshFile{"trimesh/polygonfaces.obj", 3, false},
                                         MeshFile{"smallbodies/phobos.obj", 32040, true},
                                         MeshFile{"smallbodies/epimetheus.obj", 5040, true},
                                         MeshFile{"smallbodies/216Kleopatra.obj", 4092, false},
                                         MeshFile{"spot/spot_triangulated.obj", 5856, true},
                                         MeshFile{"qt3d/starfield.obj", 64 + 2 * 960, true},
                                         MeshFile{"qt3d/ring.obj", 2 * 140, true},
                                         MeshFile{"qt3d/plane-10x10.obj", 200, true},
                                         MeshFile{"tinyobjloader/cube.obj", 12, false}));

TEST(RealMeshes, EveryOtherFileLoads) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(folder, "meshes");
    const Said some_name_libraries_that_are_not_there;
    int files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.path().extension() != ".obj") continue;
        ++files;
        EXPECT_NO_THROW(EXPECT_GT(load_obj(entry.path()).triangles.size(), 0u)) << entry.path();
    }
    EXPECT_GE(files, 18);
}

TEST(RealMeshes, PhobosNamesItsMap) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(file, "meshes/smallbodies/phobos.obj");
    const Mesh mesh = load_obj(file);
    ASSERT_FALSE(mesh.maps.empty());
    EXPECT_EQ(mesh.maps[mesh.triangles[0].material].filename(), "phobos.jpg");
}

TEST(RealPictures, EveryFileLoadsWithFiniteValues) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(folder, "images");
    int files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file() || entry.path().filename() == "StarField.exr") continue;
        ++files;
        const Texture texture = load(entry.path());
        for (const float value : texture.image.pixels)
            ASSERT_TRUE(std::isfinite(value) && value >= 0.0f) << entry.path();
    }
    EXPECT_GE(files, 18);
}

TEST(RealPictures, SubsampledChromaSaysSo) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(file, "images/exr/StarField.exr");
    EXPECT_EQ(ERROR_OF(load(file)),
              file.string() +
                  ": cannot be read as a picture: its colour is stored at a lower resolution (subsampled "
                  "luminance/chroma); save it as RGB");
}

TEST(RealPictures, SizesAndCredits) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(m101, "images/m101_heic0602a.jpg");
    ASTROSPLAT_TEST_DATA_OR_SKIP(spider, "images/red_spider_heic0109a.jpg");
    const Texture texture = load(m101);
    EXPECT_EQ(texture.image.width, 1920);
    EXPECT_EQ(texture.image.height, 1200);
    EXPECT_HAS(texture.credit, "K.D. Kuntz");
    EXPECT_HAS(texture.credit, "European Space Agency");
    EXPECT_EQ(texture.credit.find('\n'), std::string::npos);
    EXPECT_HAS(load(spider).credit, "Garrelt Mellema (Leiden University, the Netherlands)");
}

TEST(RealPictures, DerivedAlphaTimesColourIsThePicture) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(file, "images/m42.png");
    const Texture texture = load(file);
    const Image linear = load_linear_image(file);
    EXPECT_TRUE(texture.divided);
    for (std::int64_t i = 0; i < linear.width * linear.height; ++i) {
        const auto at = std::size_t(4 * i);
        for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(texture.image.pixels[at + c], linear.pixels[at + c]);
        ASSERT_EQ(texture.image.pixels[at + 3],
                  std::max({linear.pixels[at], linear.pixels[at + 1], linear.pixels[at + 2]}));
    }
}

TEST(RealPictures, GrayWithAlphaUsesTheFilesAlpha) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(file, "images/tiff/minisblack-2c-8b-alpha.tiff");
    const Picture picture = read_picture(file);
    ASSERT_TRUE(picture.has_alpha());
    const Texture texture = load(file);
    EXPECT_EQ(texture.credit, "Stockdisc");
    for (std::int64_t i = 0; i < texture.image.width * texture.image.height; ++i)
        ASSERT_EQ(texture.image.pixels[std::size_t(4 * i + 3)], picture.image.pixels[std::size_t(4 * i + 3)]);
}

TEST(RealFits, M51HasTheValuesItsReadmeStates) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(file, "fits/m51_b_kpno.fits");
    const std::vector<FitsHdu> hdus = describe_fits(file);
    ASSERT_EQ(hdus.size(), 1u);
    EXPECT_EQ(hdus[0].axes, (std::vector<std::int64_t>{512, 512}));
    EXPECT_EQ(hdus[0].bitpix, 16);
    EXPECT_EQ(hdus[0].range.min, -1.0);
    EXPECT_EQ(hdus[0].range.max, 19936.0);
    EXPECT_EQ(hdus[0].nan_count, 0);
}

TEST(RealFits, EveryFileLoads) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(folder, "fits");
    int files = 0;
    for (const auto& entry : fs::directory_iterator(folder)) {
        ++files;
        ASSERT_TRUE(is_fits(entry.path())) << entry.path();
        EXPECT_FALSE(describe_fits(entry.path()).empty());
        const Texture texture = load(entry.path());
        float most = 0.0f;
        for (const float value : texture.image.pixels) {
            ASSERT_TRUE(value >= 0.0f && value <= 1.0f) << entry.path();
            most = std::max(most, value);
        }
        EXPECT_EQ(most, 1.0f) << entry.path();
    }
    EXPECT_EQ(files, 14);
}

TEST(RealFits, FirstHduWithAPicture) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(several, "fits/test0.fits");
    ASTROSPLAT_TEST_DATA_OR_SKIP(compressed, "fits/comp.fits");
    const std::vector<FitsHdu> hdus = describe_fits(several);
    ASSERT_EQ(hdus.size(), 5u);
    EXPECT_EQ(hdus[0].kind, "empty");
    EXPECT_EQ(read_fits(several, "auto", 0).hdu, 1);
    EXPECT_EQ(read_fits(several, "3", 0).hdu, 3);
    EXPECT_EQ(read_fits(several, hdus[1].name, 0).hdu, 1);
    EXPECT_HAS(load(several).summary, "HDU 1");
    EXPECT_EQ(describe_fits(compressed)[1].kind, "compressed image");
    EXPECT_GT(read_fits(compressed, "auto", 0).width, 1);
}

TEST(RealFits, CubePlanes) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(file, "fits/l1448_13co.fits");
    EXPECT_EQ(read_fits(file, "auto", 0).width, 105);
    EXPECT_NE(read_fits(file, "auto", 52).values[5000], read_fits(file, "auto", 20).values[5000]);
    EXPECT_THROW(read_fits(file, "auto", 53), std::runtime_error);
}

TEST(RealFits, ThreeBandsBecomeOnePicture) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(k, "fits/gc_2mass_k.fits");
    ASTROSPLAT_TEST_DATA_OR_SKIP(h, "fits/gc_2mass_h.fits");
    ASTROSPLAT_TEST_DATA_OR_SKIP(j, "fits/gc_2mass_j.fits");
    TextureSettings settings;
    settings.alpha = TextureSettings::Alpha::one;
    const Texture rgb = load_texture({k, h, j}, settings, Wrap::clamp);
    const Image red = load(k, settings).image, green = load(h, settings).image,
                blue = load(j, settings).image;
    ASSERT_EQ(rgb.image.width, 721);
    for (std::int64_t i = 0; i < rgb.image.width * rgb.image.height; ++i) {
        const auto at = std::size_t(4 * i);
        ASSERT_EQ(rgb.image.pixels[at], red.pixels[at]);
        ASSERT_EQ(rgb.image.pixels[at + 1], green.pixels[at + 1]);
        ASSERT_EQ(rgb.image.pixels[at + 2], blue.pixels[at + 2]);
    }
}

}  // namespace
}  // namespace astrosplat
