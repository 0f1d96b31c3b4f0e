// The cache of generated sets: the same bits as generated, a recipe that follows every input, a size limit,
// processes that share a folder, and folders and entries that cannot be used.
#include "sets/kept.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <csignal>

#include "core/log.h"
#include "sets/load_source.h"
#include "sets/set_sample.h"
#include "splat_files/native.h"
#include "support/pixmap.h"
#include "support/test.h"
#include "unit/splat_files/file_support.h"

namespace astrosplat {
namespace {

std::string picture(int size, int blue = 128) {
    return test::pixmap(size, size,
                        [&](int x, int y, int k) { return k == 2 ? blue : 8 * (k == 0 ? x : y); });
}

constexpr const char* triangle =
    "mtllib a.mtl\nv 0 0 0\nv 4 0 0\nv 0 4 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n";

using test::bytes_of;

class SetCacheTest : public testing::Test {
  protected:
    SetCacheTest() {
        folder_.file("p.ppm", picture(16));
        source_.meshes = {{"plane", {folder_ / "p.ppm"}, 0.15}};
        source_.count = 3000;
        cache_.folder = folder_ / "sets";
    }

    int locked(const fs::path& file) const {
        fs::create_directories(cache_.folder);
        const int lock = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        EXPECT_EQ(flock(lock, LOCK_EX), 0);
        return lock;
    }
    /// A source with a mesh file whose picture comes from its own material.
    SourceParams mesh_source() const {
        folder_.file("a.obj", triangle);
        folder_.file("a.mtl", "newmtl m\nmap_Kd p.ppm\n");
        SourceParams source = source_;
        source.meshes = {{folder_ / "a.obj", {}, 0.15}};
        return source;
    }
    std::vector<fs::path> entries(const std::string& ending = ".splats") const {
        std::vector<fs::path> files;
        std::error_code ignored;
        for (const auto& each : fs::directory_iterator(cache_.folder, ignored))
            if (each.path().extension() == ending) files.push_back(each.path());
        return files;
    }
    LoadedSet load(const SourceParams& source, const std::string& name = "dust") const {
        return load_source(cache_, source, name);
    }
    LoadedSet load() const { return load(source_); }
    static std::string name(const SourceParams& source, const std::string& layer = "dust") {
        return recipe_of(source, layer).name;
    }
    std::string name() const { return name(source_); }
    fs::path entry_file(const std::string& ending) const { return cache_.folder / (name() + ending); }
    fs::path texel_file(const SourceParams& source) const {
        return cache_.folder / (name(source) + ".texels");
    }
    fs::path geometry_file(const SourceParams& source) const {
        return cache_.folder / (geometry_recipe(plan_columns(source, "dust", {})).name + ".splats");
    }

    TempFolder folder_;
    SourceParams source_;
    SetCache cache_;
    Said said_;
};

TEST_F(SetCacheTest, TheSecondTimeTheSameBitsComeFromTheFile) {
    for (const SourceParams& source : {source_, mesh_source()}) {
        const SplatSet plain = load_source(source, "dust");
        ASSERT_GT(plain.size(), 500);
        EXPECT_FALSE(sample_there(cache_, source, "dust"));
        const LoadedSet first = load(source), second = load(source);
        EXPECT_FALSE(first.cached);
        EXPECT_TRUE(second.cached);
        expect_same_set(first.set, plain);
        expect_same_set(second.set, plain);
        EXPECT_EQ(sample_there(cache_, source, "dust").value().splats, plain.size());
    }
    EXPECT_EQ(entries().size(), 2u);
    EXPECT_TRUE(entries(".lock").empty());
    EXPECT_TRUE(said_.warnings.empty());
}

TEST_F(SetCacheTest, TheFileHasAllColumnsWhateverIsWanted) {
    const OptionalColumns wanted{true, false, false};
    const LoadedSet first = load_source(cache_, source_, "dust", {}, nullptr, wanted);
    const LoadedSet second = load_source(cache_, source_, "dust", {}, nullptr, wanted);
    EXPECT_FALSE(first.cached);
    EXPECT_TRUE(second.cached);
    SplatSet expected = load_source(source_, "dust");
    expect_same_set(load().set, expected);
    drop_columns(expected, wanted);
    expect_same_set(first.set, expected);
    expect_same_set(second.set, expected);
}

TEST_F(SetCacheTest, WithoutAFolderNothingIsKept) {
    EXPECT_FALSE(load_source(SetCache{}, source_, "dust").cached);
    EXPECT_FALSE(load_source(SetCache{}, source_, "dust").cached);
    EXPECT_FALSE(fs::exists(cache_.folder));
}

TEST_F(SetCacheTest, SplatFilesPassBy) {
    SourceParams file;
    file.kind = SourceKind::splats;
    file.file = folder_ / "a.splats";
    write_native(file.file, load_source(source_, "dust"));
    EXPECT_FALSE(load(file).cached);
    EXPECT_FALSE(load(file).cached);
    EXPECT_FALSE(fs::exists(cache_.folder));
}

// ---- the recipe

MaskParams& one_mask(SourceParams& source) {
    source.texture.mask.resize(1);
    return source.texture.mask[0];
}

UvCamera& seen_from(SourceParams& source, double y) {
    source.uv = UvMode::camera;
    source.uv_camera.position = glm::dvec3(0.0, y, 0.0);
    return source.uv_camera;
}

auto& shape(SourceParams& source, const char* mesh) {
    source.meshes[0].mesh = mesh;
    return source.meshes[0].shape;
}

/// Takes names of files that must differ from each other.
void expect_different(std::vector<std::string> names) {
    std::ranges::sort(names);
    EXPECT_EQ(std::ranges::adjacent_find(names), names.end());
}

TEST_F(SetCacheTest, EveryParameterOfASourceChangesTheName) {
    using Settings = TextureSettings;
    const std::vector<std::function<void(SourceParams&)>> changes = {
        [](SourceParams& s) { s.meshes[0].mesh = "disk"; },
        [](SourceParams& s) { s.meshes[0].mesh = "relief"; },
        [](SourceParams& s) { s.meshes[0].mesh = "relief", s.meshes[0].relief = 0.2; },
        [](SourceParams& s) { s.meshes.push_back(s.meshes[0]); },
        [](SourceParams& s) { s.meshes[0].texture.push_back(s.meshes[0].texture[0]); },
        [](SourceParams& s) { s.texture.colorspace = Settings::Colorspace::linear; },
        [](SourceParams& s) { s.texture.alpha = Settings::Alpha::one; },
        [](SourceParams& s) { s.texture.unpremultiply = Settings::Unpremultiply::no; },
        [](SourceParams& s) { s.texture.hdu = "SCI"; },
        [](SourceParams& s) { s.texture.plane = 1; },
        [](SourceParams& s) { s.texture.stretch = Settings::Stretch::log; },
        [](SourceParams& s) { s.texture.black = 0.25; },
        [](SourceParams& s) { s.texture.white = 0.25; },
        [](SourceParams& s) { s.texture.softening = 0.2; },
        [](SourceParams& s) { s.texture.filter = Settings::Filter::area; },
        [](SourceParams& s) { s.texture.wrap = Settings::Wrap::black; },
        [](SourceParams& s) { s.texture.derive = Derived::dust; },
        [](SourceParams& s) { s.texture.smooth = 0.1; },
        [](SourceParams& s) { s.texture.detail = 0.1; },
        [](SourceParams& s) { s.texture.mask.resize(1); },
        [](SourceParams& s) { s.texture.mask.resize(2); },
        [](SourceParams& s) { s.texture.mask.resize(1), s.texture.mask[0].any.resize(1); },
        [](SourceParams& s) { one_mask(s).luminance = glm::dvec2(0.1, 0.2); },
        [](SourceParams& s) { one_mask(s).hue = glm::dvec2(0.1, 0.2); },
        [](SourceParams& s) { one_mask(s).saturation = glm::dvec2(0.1, 0.2); },
        [](SourceParams& s) { one_mask(s).ellipse = glm::dvec4(0.1); },
        [](SourceParams& s) { one_mask(s).ellipse = glm::dvec4(0.1), s.texture.mask[0].turn = 3.0; },
        [](SourceParams& s) { one_mask(s).image = s.meshes[0].texture[0]; },
        [](SourceParams& s) { one_mask(s).derive = Derived::dust; },
        [](SourceParams& s) { one_mask(s).feather = 0.5; },
        [](SourceParams& s) { one_mask(s).invert = true; },
        [](SourceParams& s) { s.buffer = glm::dvec3(0.1, 0.2, 0.3); },
        [](SourceParams& s) { s.buffer = glm::dvec3(0.1, 0.2, 0.4); },
        [](SourceParams& s) { s.voxels = glm::i64vec3(9, 8, 7); },
        [](SourceParams& s) { s.voxels = glm::i64vec3(9, 8, 6); },
        [](SourceParams& s) { s.voxel_size = 0.1; },
        [](SourceParams& s) { s.count = 3001; },
        [](SourceParams& s) { s.splats = 3000; },
        [](SourceParams& s) { s.jitter = 0.1; },
        [](SourceParams& s) { s.jitter = 0.1 + 1e-16 * 2; },
        [](SourceParams& s) { s.max_distance = 0.3; },
        [](SourceParams& s) { s.uv = UvMode::planar_xz; },
        [](SourceParams& s) { s.uv = UvMode::planar_xz, s.uv_width = 4.0; },
        [](SourceParams& s) { s.uv = UvMode::planar_xz, s.uv_width = 4.0, s.uv_center.x = 1.0; },
        [](SourceParams& s) { s.uv = UvMode::planar_xz, s.back = BackWall::mirrored; },
        [](SourceParams& s) { s.uv = UvMode::planar_xz, s.back = BackWall::varied; },
        [](SourceParams& s) { s.structure.kind = StructureKind::disk; },
        [](SourceParams& s) { s.structure.kind = StructureKind::disk, s.structure.flare = 0.1; },
        [](SourceParams& s) { s.structure.kind = StructureKind::disk, s.structure.warp = 0.1; },
        [](SourceParams& s) { s.structure.kind = StructureKind::disk, s.structure.most_texels = 1000; },
        [](SourceParams& s) { s.structure.kind = StructureKind::axis; },
        [](SourceParams& s) { s.structure.kind = StructureKind::axis, s.structure.axis_angle = 30.0; },
        [](SourceParams& s) { s.structure.kind = StructureKind::axis, s.structure.tilt = 30.0; },
        [](SourceParams& s) { seen_from(s, 3.0); },
        [](SourceParams& s) { seen_from(s, 4.0); },
        [](SourceParams& s) { seen_from(s, 3.0).target.x = 1.0; },
        [](SourceParams& s) { seen_from(s, 3.0).up.x = 1.0; },
        [](SourceParams& s) { seen_from(s, 3.0).fov = 30.0; },
        [](SourceParams& s) { seen_from(s, 3.0).height = 5.0; },
        [](SourceParams& s) { seen_from(s, 3.0).height = 6.0; },
        [](SourceParams& s) { s.meshes[0].mesh = "hourglass"; },
        [](SourceParams& s) { shape(s, "hourglass").waist = 0.5; },
        [](SourceParams& s) { shape(s, "hourglass").width = 0.6; },
        [](SourceParams& s) { s.meshes[0].mesh = "shell"; },
        [](SourceParams& s) { shape(s, "shell").thickness = 0.5; },
        [](SourceParams& s) { shape(s, "bubble").opening = 50.0; },
        [](SourceParams& s) { shape(s, "bubble").opening = 51.0; },
        [](SourceParams& s) { shape(s, "spheroid").flattening = 0.5; },
        [](SourceParams& s) { shape(s, "spheroid").shells = 2; },
        [](SourceParams& s) { shape(s, "spheroid").concentration = 2; },
        [](SourceParams& s) { shape(s, "ring").tube = 0.1; },
        [](SourceParams& s) { shape(s, "ring").tube = 0.3; },
        [](SourceParams& s) {
            shape(s, "revolution").outline = {{1, 2}};
        },
        [](SourceParams& s) {
            shape(s, "revolution").outline = {{2, 1}};
        },
        [](SourceParams& s) { s.meshes[0].mesh = "sheet"; },
        [](SourceParams& s) { shape(s, "sheet").depth = 0.5; },
        [](SourceParams& s) { shape(s, "sheet").blur = 0.05; },
        [](SourceParams& s) { shape(s, "sheet").depth_map = s.meshes[0].texture[0]; },
        [](SourceParams& s) { s.seed = 5; },
    };
    std::vector<std::string> names = {name(), name(source_, "stars")};
    for (const auto& change : changes) {
        SourceParams source = source_;
        change(source);
        names.push_back(name(source));
        EXPECT_EQ(names.back().size(), 64u);
    }
    expect_different(names);
}

TEST_F(SetCacheTest, WhatDoesNotReachTheSetStaysOutOfTheName) {
    SourceParams seeded = source_, sized = source_, moved = source_;
    seeded.seed = 5;
    EXPECT_EQ(name(seeded), name(seeded, "stars"));
    sized.voxel_size = 0.1;
    const std::string of_sized = name(sized);
    sized.count = 7;
    sized.meshes[0].relief = 0.7;
    sized.meshes[0].shape.waist = 0.7;
    sized.uv_width = 3.0;
    sized.uv_camera.fov = 3.0;
    sized.back = BackWall::varied;
    EXPECT_EQ(name(sized), of_sized);
    fs::copy_file(folder_ / "p.ppm", folder_ / "other.ppm");
    moved.meshes[0].texture = {folder_ / "other.ppm"};
    EXPECT_EQ(name(moved), name());
}

TEST_F(SetCacheTest, BytesOfEveryInputChangeTheName) {
    const SourceParams source = mesh_source();
    std::vector<std::string> names = {name(source)};
    folder_.file("p.ppm", picture(16, 129));
    names.push_back(name(source));
    folder_.file("a.obj", std::string(triangle) + "#\n");
    names.push_back(name(source));
    folder_.file("a.mtl", "newmtl m\nmap_Kd q.ppm\n");
    names.push_back(name(source));
    folder_.file("q.ppm", picture(8));
    names.push_back(name(source));
    expect_different(names);
}

TEST_F(SetCacheTest, HashingInputsCanBeCancelled) {
    const std::atomic<bool> cancelled{true};
    EXPECT_THROW(recipe_of(mesh_source(), "dust", Progress{{}, &cancelled}), Cancelled);
}

TEST_F(SetCacheTest, InputsThatCannotBeReadHaveNoNameAndTheLoaderSaysWhy) {
    source_.meshes[0].texture = {folder_ / "none.ppm"};
    EXPECT_EQ(name(), "");
    const std::string said = ERROR_OF(load());
    EXPECT_HAS(said, "layer 'dust': ");
    EXPECT_HAS(said, "none.ppm");
    EXPECT_FALSE(fs::exists(cache_.folder));
}

// ---- the folder

TEST_F(SetCacheTest, FolderOfTheEnvironment) {
    const auto with = [](const char* own, const char* xdg, const char* home) {
        const Variable a("ASTROSPLAT_CACHE", own), b("XDG_CACHE_HOME", xdg), c("HOME", home);
        return default_cache_folder();
    };
    EXPECT_EQ(with("/a", "/b", "/c"), "/a");
    EXPECT_EQ(with("", "/b", "/c"), "/b/astrosplat");
    EXPECT_EQ(with(nullptr, "b", "/c"), "/c/.cache/astrosplat");
    EXPECT_EQ(with(nullptr, nullptr, "/c"), "/c/.cache/astrosplat");
    EXPECT_EQ(with(nullptr, nullptr, nullptr), "");
}

TEST_F(SetCacheTest, TheLeastRecentlyUsedGoFirst) {
    const auto with_seed = [&](std::uint32_t seed) {
        SourceParams source = source_;
        source.seed = seed;
        return source;
    };
    for (const std::uint32_t seed : {1u, 2u, 3u}) load(with_seed(seed));
    std::uintmax_t three = 0;
    for (const char* const ending : {".splats", ".texels"})
        for (const fs::path& file : entries(ending)) three += fs::file_size(file);
    const auto age = [&](std::uint32_t seed, int hours) {
        const auto then = fs::file_time_type::clock::now() - std::chrono::hours(hours);
        fs::last_write_time(geometry_file(with_seed(seed)), then);
        fs::last_write_time(texel_file(with_seed(seed)), then);
    };
    age(1, 30), age(2, 20), age(3, 10);
    EXPECT_TRUE(load(with_seed(1)).cached);  // used now: 2 is the oldest
    cache_.limit_bytes = std::int64_t(three) + 2000;
    load(with_seed(4));
    EXPECT_EQ(entries().size(), 3u);
    EXPECT_EQ(entries(".texels").size(), 3u);
    EXPECT_FALSE(sample_there(cache_, with_seed(2), "dust"));
    for (const std::uint32_t seed : {1u, 3u, 4u}) EXPECT_TRUE(load(with_seed(seed)).cached) << seed;
}

TEST_F(SetCacheTest, ASetLargerThanTheLimitIsNotKeptAndPushesNothingOut) {
    SourceParams small = source_;
    small.count = 100;
    load(small);
    cache_.limit_bytes = 20000;
    EXPECT_FALSE(load().cached);
    EXPECT_FALSE(load().cached);
    EXPECT_EQ(entries().size(), 1u);
    EXPECT_TRUE(load(small).cached);
    EXPECT_HAS(said_.lines[said_.lines.size() - 2], "is not kept: the cache may hold 19.5 KiB");
}

// ---- entries and folders that cannot be used

TEST_F(SetCacheTest, DamagedEntriesAreMadeAgainWithAWarning) {
    const SplatSet set = load().set;
    for (const fs::path& file : {geometry_file(source_), texel_file(source_)}) {
        const std::string whole = bytes_of(file);
        std::vector<std::string> damaged = {"", "something else", whole.substr(0, whole.size() / 2), whole};
        damaged.back()[whole.size() / 2] ^= 1;
        for (const std::string& bytes : damaged) {
            fs::remove(file);
            std::ofstream(file, std::ios::binary) << bytes;
            said_.warnings.clear();
            const LoadedSet again = load();
            EXPECT_FALSE(again.cached);
            EXPECT_EQ(again.geometry_cached, file == texel_file(source_));
            expect_same_set(again.set, set);
            EXPECT_HAS(said_.one_warning(), "; the set is generated again");
            forget_warnings();
            EXPECT_EQ(bytes_of(file), whole);
            EXPECT_TRUE(load().cached);
        }
    }
}

TEST_F(SetCacheTest, BodiesThatAreDamagedAreMadeAgain) {
    source_.structure.kind = StructureKind::disk;
    const SplatSet set = load().set;
    const fs::path file = entry_file(".splats");
    std::string bytes = bytes_of(file);
    bytes[bytes.size() / 2] ^= 1;
    fs::remove(file);
    std::ofstream(file, std::ios::binary) << bytes;
    const LoadedSet again = load();
    EXPECT_FALSE(again.cached || again.geometry_cached);
    expect_same_set(again.set, set);
    EXPECT_TRUE(load().cached);
}

// ---- geometry and texels

TEST_F(SetCacheTest, HowPicturesAreReadNeedsNoOtherGeometry) {
    load();
    std::size_t texels = 1;
    const std::function<void(SourceParams&)> changes[] = {
        [](SourceParams& s) { s.texture.alpha = TextureSettings::Alpha::luminance; },
        [](SourceParams& s) { s.texture.colorspace = TextureSettings::Colorspace::linear; },
        [](SourceParams& s) { s.texture.unpremultiply = TextureSettings::Unpremultiply::no; },
        [](SourceParams& s) { s.texture.filter = TextureSettings::Filter::area; },
        [](SourceParams& s) { s.texture.smooth = 0.02; },
        [](SourceParams& s) { s.texture.mask.emplace_back().luminance = glm::dvec2(0.5, 1.0); },
        [this](SourceParams& s) { s.meshes[0].texture = {folder_.file("q.ppm", picture(16, 7))}; },
    };
    for (const auto& change : changes) {
        SourceParams source = source_;
        change(source);
        const LoadedSet loaded = load(source);
        EXPECT_FALSE(loaded.cached);
        EXPECT_TRUE(loaded.geometry_cached);
        expect_same_set(loaded.set, load_source(source, "dust"));
        EXPECT_EQ(entries().size(), 1u);
        EXPECT_EQ(entries(".texels").size(), ++texels);
        const LoadedSet again = load(source);
        EXPECT_TRUE(again.cached);
        expect_same_set(again.set, loaded.set);
        EXPECT_EQ(sample_there(cache_, source, "dust").value().splats, loaded.set.size());
    }
}

TEST_F(SetCacheTest, LevelsBringBackWhatOthersHid) {
    const auto shown_above = [&](double luminance) {
        SourceParams source = source_;
        source.texture.mask.emplace_back().luminance = glm::dvec2(luminance, 1.0);
        return load(source);
    };
    const LoadedSet few = shown_above(0.35), many = shown_above(0.2);
    EXPECT_GT(few.set.size(), 100);
    EXPECT_LT(2 * few.set.size(), many.set.size());
    EXPECT_FALSE(few.geometry_cached);
    EXPECT_TRUE(many.geometry_cached);
    EXPECT_EQ(few.set.size() + few.set.zero_alpha, many.set.size() + many.set.zero_alpha);
}

TEST_F(SetCacheTest, OfSeveralMaterialsEveryFaceHasItsPicture) {
    folder_.file("q.ppm", picture(16, 7));
    folder_.file("two.mtl", "newmtl a\nmap_Kd p.ppm\nnewmtl b\nmap_Kd q.ppm\n");
    source_.meshes = {
        {folder_.file("two.obj",
                      "mtllib two.mtl\nv 0 0 0\nv 4 0 0\nv 0 4 0\nv 4 4 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                      "usemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 2/2 4/1 3/3\n"),
         {},
         0.15}};
    load();
    source_.texture.filter = TextureSettings::Filter::area;  // boxes differ from face to face
    const LoadedSet other = load();
    EXPECT_TRUE(other.geometry_cached);
    expect_same_set(other.set, load_source(source_, "dust"));
}

TEST_F(SetCacheTest, WhereThePictureMakesTheShapeItMakesTheGeometry) {
    source_.meshes[0].mesh = "relief";
    load();
    source_.texture.colorspace = TextureSettings::Colorspace::linear;
    EXPECT_FALSE(load().geometry_cached);
    source_.texture.mask.emplace_back().luminance = glm::dvec2(0.2, 1.0);  // which shapes do not see
    EXPECT_TRUE(load().geometry_cached);
}

TEST_F(SetCacheTest, SplatsAreCountedAfterTheLevels) {
    source_.splats = 3000;
    const LoadedSet all = load();
    source_.texture.filter = TextureSettings::Filter::nearest;
    EXPECT_TRUE(load().geometry_cached);
    source_.texture.mask.emplace_back().luminance = glm::dvec2(0.3, 1.0);
    const LoadedSet masked = load();
    EXPECT_FALSE(masked.geometry_cached);  // as many of fewer: another lattice
    EXPECT_NEAR(double(masked.set.size()), 3000.0, 300.0);
    EXPECT_NEAR(double(all.set.size()), 3000.0, 300.0);
}

// As after a collision of hashes, or by a hand that renames files.
TEST_F(SetCacheTest, AnEntryOfAnotherSetUnderThisNameIsNotTaken) {
    const SplatSet set = load().set;
    SourceParams other = source_;
    other.seed = 77;
    for (const bool geometry : {true, false}) {
        const auto file_of = [&](const SourceParams& s) {
            return geometry ? geometry_file(s) : texel_file(s);
        };
        load(other);
        fs::rename(file_of(other), file_of(source_));
        said_.warnings.clear();
        const LoadedSet again = load();
        EXPECT_FALSE(again.cached);
        expect_same_set(again.set, set);
        EXPECT_HAS(said_.one_warning(), "expected that of the set asked for");
        EXPECT_TRUE(again.set.recipe.empty());
        forget_warnings();
        const LoadedSet repaired = load();
        EXPECT_TRUE(repaired.cached);
        EXPECT_TRUE(repaired.set.recipe.empty());
    }
}

TEST_F(SetCacheTest, AFolderThatCannotBeMadeIsAWarning) {
    cache_.folder = folder_.file("file", "x") / "sets";
    EXPECT_FALSE(load().cached);
    EXPECT_HAS(said_.one_warning(), "cannot be made");
}

TEST_F(SetCacheTest, ThePlaceOfAnEntryTakenByAFolderIsAWarning) {
    fs::create_directories(entry_file(".texels"));
    EXPECT_FALSE(load().cached);
    EXPECT_HAS(said_.one_warning(), "what was generated is not kept");
}

TEST_F(SetCacheTest, AReadOnlyFolderIsReadAndItsLackIsAWarning) {
    if (geteuid() == 0) GTEST_SKIP() << "root writes everywhere";
    load();
    fs::permissions(cache_.folder, fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_TRUE(load().cached);
    EXPECT_TRUE(said_.warnings.empty());
    EXPECT_FALSE(load(source_, "stars").cached);
    fs::permissions(cache_.folder, fs::perms::owner_all);
    EXPECT_HAS(said_.one_warning(), "what was generated is not kept");
}

// ---- several processes

TEST_F(SetCacheTest, WhatDeadProcessesLeftIsRemovedAndNothingElse) {
    fs::create_directories(cache_.folder);
    const std::string dead(64, 'd'), alive(64, 'a'), own = name();
    const auto leave = [&](const std::string& name) {
        std::ofstream(cache_.folder / name) << "x";
        return cache_.folder / name;
    };
    const auto temporary = [](const std::string& name) { return "." + name + ".1-2-3.part.splats"; };
    const std::vector<fs::path> gone = {leave(temporary(dead)), leave(dead + ".lock"), leave(own + ".lock"),
                                        leave(temporary(own))};
    const std::vector<fs::path> stay = {leave(temporary(alive)), leave(alive + ".lock"), leave("mine.lock"),
                                        leave(".mine.part.splats"), leave("notes.txt")};
    const int locks[] = {locked(stay[0]), locked(stay[1])};
    load();
    for (const int lock : locks) close(lock);
    for (const fs::path& file : gone) EXPECT_FALSE(fs::exists(file)) << file;
    for (const fs::path& file : stay) EXPECT_TRUE(fs::exists(file)) << file;
}

TEST_F(SetCacheTest, OthersWaitForTheOneThatGenerates) {
    const SetCache elsewhere{folder_ / "elsewhere", 0};
    const SplatSet set = load_source(elsewhere, source_, "dust").set;
    for (const bool same_texels : {true, false}) {
        fs::remove_all(cache_.folder);
        const fs::path held =
            (same_texels ? texel_file(source_) : geometry_file(source_)).replace_extension(".lock");
        const int lock = locked(held);
        std::optional<LoadedSet> loaded;
        std::atomic<bool> waits{false}, ended{false};
        set_log_sink([&](LogLevel, const std::string& line) { waits = waits || line.find("waiting") < 99; });
        std::thread other([&] { loaded = load(), ended = true; });
        while (!waits && !ended) std::this_thread::yield();
        EXPECT_FALSE(ended);
        for (const auto& file : fs::directory_iterator(elsewhere.folder))
            if (same_texels || file.path().extension() == ".splats")
                fs::copy_file(file.path(), cache_.folder / file.path().filename());
        fs::remove(held);  // as FileLock gives it back
        close(lock);
        other.join();
        EXPECT_EQ(loaded->cached, same_texels);
        EXPECT_TRUE(loaded->geometry_cached);
        expect_same_set(loaded->set, set);
    }
}

TEST_F(SetCacheTest, WaitingCanBeCancelled) {
    const int lock = locked(entry_file(".lock"));
    std::atomic<bool> cancelled{false};
    set_log_sink([&](LogLevel, const std::string& line) { cancelled = line.find("waiting") < 99; });
    EXPECT_THROW(load_source(cache_, source_, "dust", Progress{{}, &cancelled}), Cancelled);
    EXPECT_TRUE(cancelled);
    close(lock);
}

TEST_F(SetCacheTest, ACancelledRunLeavesNothing) {
    std::atomic<bool> cancelled{false};
    const Progress progress{[&](double) { cancelled = true; }, &cancelled};  // when some is generated
    EXPECT_THROW(load_source(cache_, source_, "dust", progress), Cancelled);
    EXPECT_TRUE(fs::is_empty(cache_.folder));
}

TEST_F(SetCacheTest, AProcessThatIsKilledGivesWay) {
    fs::create_directories(cache_.folder);
    const fs::path ready = folder_ / "ready", lock_name = entry_file(".lock");
    const pid_t child = fork();
    if (child == 0) {  // takes the lock, says so, and is killed
        locked(lock_name);
        close(open(ready.c_str(), O_CREAT | O_WRONLY, 0666));
        for (;;) pause();
    }
    const auto soon = [](const auto& is_so) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
        while (!is_so() && std::chrono::steady_clock::now() < end) std::this_thread::yield();
        return is_so();
    };
    EXPECT_TRUE(soon([&] { return fs::exists(ready); }));
    std::optional<LoadedSet> loaded;
    std::atomic<bool> waits{false}, ended{false}, cancelled{false};
    set_log_sink([&](LogLevel, const std::string& line) { waits = waits || line.find("waiting") < 99; });
    std::thread other([&] {
        try {
            loaded = load_source(cache_, source_, "dust", Progress{{}, &cancelled});
        } catch (const Cancelled&) {
        }
        ended = true;
    });
    EXPECT_TRUE(soon([&] { return waits || ended; }));
    EXPECT_FALSE(ended) << "it lives";
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    EXPECT_TRUE(soon([&] { return ended.load(); })) << "it is gone";
    cancelled = true;
    other.join();
    ASSERT_TRUE(loaded);
    EXPECT_FALSE(loaded->cached);
    EXPECT_TRUE(load().cached);
    EXPECT_TRUE(entries(".lock").empty());
}

}  // namespace
}  // namespace astrosplat
