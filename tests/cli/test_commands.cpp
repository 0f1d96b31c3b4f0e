// new, generate, convert, info, compare and parameters, with input files of every kind.
#include <sys/stat.h>

#include "scene_fixture.h"
#include "source/texture.h"
#include "support/pixmap.h"
#include "support/process_state.h"

namespace astrosplat::test {
namespace {

class Commands : public SceneTest {
  protected:
    nlohmann::json info(const std::string& file) const {
        const RunResult result = expect_success(run({"info", file, "--json"}));
        return nlohmann::json::parse(result.out);
    }
};

TEST_F(Commands, ConvertKeepsEverySplat) {
    expect_success(run({"convert", "stars.pda", "stars.splats"}));
    expect_success(run({"convert", "stars.splats", "again.pda"}));
    expect_success(run({"convert", "again.pda", "stars.ply"}));
    expect_success(run({"convert", "stars.ply", "last.splats"}));
    EXPECT_EQ(text_of(folder / "last.splats"), text_of(folder / "stars.splats"));
    const nlohmann::json described = info("stars.ply");
    EXPECT_EQ(described.at("splats"), 300);
}

TEST_F(Commands, QuietMeansNoProgressEither) {
    EXPECT_NE(run({"convert", "stars.pda", "a.splats"}).err, "");
    const RunResult quiet = expect_success(run({"-q", "convert", "stars.pda", "b.splats"}));
    EXPECT_EQ(quiet.err, "");
}

TEST_F(Commands, AFileLargerThanAllowedIsOneErrorAndLeavesNothing) {
    const std::set<std::string> names = names_in(".");
    const RunResult result = [&] {
        const FileLimit full(4096);
        return run({"-q", "convert", "stars.pda", "a.splats"});
    }();
    expect_one_line(result, 4, "a.splats");
    EXPECT_EQ(names_in("."), names);
}

TEST_F(Commands, OneSplatIsSingular) {
    write_text(folder / "one.pda", cube_of_splats(1));
    EXPECT_EQ(run({"convert", "one.pda", "one.ply"}).out, "one.ply: 1 splat\n");
    EXPECT_EQ(run({"convert", "stars.pda", "stars.ply"}).out, "stars.ply: 300 splats\n");
}

TEST_F(Commands, NamesAreShownWithoutControlCharacters) {
    fs::rename(folder / "stars.pda", folder / "st\x1b[2Jars.pda");
    for (const Words& words : {Words{"info", "st\x1b[2Jars.pda"},
                               {"convert", "st\x1b[2Jars.pda", "o\x1b[2J.ply"},
                               {"info", "no\x1b[2J.pda"}}) {
        const RunResult result = run(words);
        EXPECT_EQ((result.out + result.err).find('\x1b'), std::string::npos) << result.out << result.err;
        EXPECT_NE((result.out + result.err).find("\\x1b[2J"), std::string::npos) << result.out << result.err;
    }
}

TEST_F(Commands, InfoOfAPictureThatCannotBeReadSaysWhy) {
    write_text(folder / "cut.ppm", small_picture().substr(0, 200));
    EXPECT_HAS(expect_success(run({"info", "cut.ppm"})).err, "cut.ppm: cannot be read as a picture: ");
}

TEST_F(Commands, InfoNamesTheFormatsThatAreNotRead) {
    write_text(folder / "c.abc", "Ogawa\xff");
    write_text(folder / "c.FBX", "Kaydara FBX Binary  ");
    write_text(folder / "c.ksplat", "x");
    expect_one_line(run({"info", "c.abc"}), 2,
                    "c.abc: expected a format that is read, found .abc (Alembic is not read: save cameras as "
                    ".usda or .chan)");
    expect_one_line(run({"info", "c.FBX"}), 2,
                    "found .FBX (FBX is not read: save cameras as .usda or .chan)");
    expect_one_line(run({"info", "c.ksplat"}), 2, "found .ksplat (splat-transform makes a .ply of it)");
}

TEST_F(Commands, ConvertRefusesWhatItShould) {
    expect_one_line(run({"convert", "stars.pda", "stars.xyz"}), 2, ".splats");
    expect_one_line(run({"convert", "stars.pda", "dust.pda"}), 2, "--overwrite");
    expect_success(run({"convert", "stars.pda", "dust.pda", "--overwrite"}));
    write_text(folder / "broken.pda",
               "ATTRIBUTES\n position\nTYPES\n V\nNUMBER_OF_PARTICLES: 2\nBEGIN DATA\n1 2 3\n");
    const RunResult broken = run({"convert", "broken.pda", "out.ply", "--progress", "none"});
    expect_one_line(broken, 2, "broken.pda");
    EXPECT_FALSE(fs::exists(folder / "out.ply"));
    EXPECT_EQ(run({"convert", "stars.pda", "/proc/astrosplat/out.ply"}).code, 4);
}

TEST_F(Commands, NewMakesASceneThatRenders) {
    write_text(folder / "picture.ppm", small_picture());
    for (const char* shape : {"plane", "relief", "disk", "sphere"}) {
        const std::string scene = std::string(shape) + ".toml";
        ASSERT_EQ(run({"new", "picture.ppm", "-o", scene, "--shape", shape}).code, 0) << shape;
        const Words arguments = {"--batch", scene, "-f", "1", "-o", std::string(shape) + ".png",
                                 "--resolution", "48x32",
                                 // Millions of splats show nothing that some do not.
                                 "--set", "layer.picture.source.count=20000"};
        expect_success(run(arguments));
    }
    expect_one_line(run({"new", "picture.ppm", "-o", "plane.toml", "--as", "galaxy"}), 2, "--overwrite");
    expect_one_line(run({"new", "picture.ppm", "-o", "cube.toml", "--shape", "cube"}), 2, "cube");
    expect_one_line(run({"new", "missing.png", "-o", "x.toml"}), 2, "missing.png");
    fs::create_directories(folder / "pictures");
    fs::copy_file(folder / "picture.ppm", folder / "pictures/m 51.ppm");
    ASSERT_EQ(run({"new", "pictures/m 51.ppm", "--as", "plane"}).out, "m 51.toml\n");
    EXPECT_HAS(text_of(folder / "m 51.toml"), "pictures/m 51.ppm");
    expect_one_line(run({"new", "pictures/m 51.ppm", "--as", "plane"}), 2, "m 51.toml");
    expect_one_line(run({"new", ".", "-o", "x.toml"}), 2, "it is a folder");
    expect_one_line(run({"new", "plane.toml", "-o", "x.toml"}), 2, "cannot be read as a picture");
    EXPECT_FALSE(fs::exists(folder / "x.toml"));
}

// Without a shape the picture becomes bodies; what kind is said with its reason, or asked for.
TEST_F(Commands, NewMakesBodiesOfAPicture) {
    write_text(folder / "picture.ppm", small_picture());
    const RunResult chosen = expect_success(run({"new", "picture.ppm", "-o", "chosen.toml"}));
    EXPECT_HAS(chosen.err, "--as chooses another");
    for (const auto& [as, kind] :
         {std::pair("galaxy", "disk"), std::pair("nebula", "sheet"), std::pair("remnant", "walls"),
          std::pair("field", "sheet"), std::pair("elliptical", "disk"), std::pair("cluster", "disk"),
          std::pair("thin", "sheet")}) {
        const std::string scene = std::string(as) + ".toml";
        const RunResult made = expect_success(run({"new", "picture.ppm", "-o", scene, "--as", as, "--film"}));
        EXPECT_EQ(made.err, "");
        const std::string text = text_of(folder / scene);
        EXPECT_HAS(text, "kind = \"" + std::string(kind) + "\"");
        EXPECT_HAS(text, "frames     = \"1-240\"");
        expect_success(run(
            {"--batch", scene, "-f", "1,160", "-o", std::string(as) + ".####.png", "--resolution", "48x32"}));
    }
    const RunResult no_axis =
        expect_success(run({"new", "picture.ppm", "-o", "planetary.toml", "--as", "planetary"}));
    EXPECT_HAS(no_axis.err, "too little: it becomes walls");
    EXPECT_HAS(text_of(folder / "planetary.toml"), "kind = \"walls\"");
    EXPECT_HAS(text_of(folder / "field.toml"), "height = 0.05, depth = 0.01");
    EXPECT_HAS(text_of(folder / "thin.toml"), "clumps = 0.0, height = 0.02, depth = 0.0");
    EXPECT_EQ(text_of(folder / "nebula.toml").find("height"), std::string::npos);
    EXPECT_EQ(text_of(folder / "chosen.toml").find("[animation]"), std::string::npos);
    expect_success(run({"new", "picture.ppm", "-o", "columns.toml", "--as", "plane"}));
    EXPECT_EQ(text_of(folder / "columns.toml").find("structure"), std::string::npos);
    expect_one_line(run({"new", "picture.ppm", "-o", "x.toml", "--as", "galxy"}), 2,
                    "did you mean 'galaxy'?");
    expect_one_line(run({"new", "picture.ppm", "-o", "x.toml", "--as", "plane", "--film"}), 2, "--film");
    expect_one_line(run({"new", "picture.ppm", "-o", "x.toml", "--as", "nebula", "--shape", "disk"}), 2,
                    "--shape");
    EXPECT_FALSE(fs::exists(folder / "x.toml"));
}

// A film's tiles are written into its scene, whose other lines stay; what they say is rendered and said.
TEST_F(Commands, DetailFollowsTheCamera) {
    write_text(folder / "picture.ppm", small_picture());
    const auto new_film = [&] {
        expect_success(
            run({"new", "picture.ppm", "-o", "f.toml", "--as", "nebula", "--film", "--overwrite"}));
        return text_of(folder / "f.toml");
    };
    const std::string film = new_film();
    EXPECT_HAS(film, "detail = ");
    EXPECT_HAS(film, "detail_tiles = \"");
    const RunResult none = expect_success(run({"detail", "f.toml", "--none"}));
    EXPECT_HAS(none.out, "more_splats: 0");
    const std::string without = text_of(folder / "f.toml");
    EXPECT_HAS(without, "# splats that look larger, close by, are divided");
    EXPECT_HAS(without, "detail = 0");
    expect_success(run({"detail", "f.toml", "--image", "levels.png"}));
    EXPECT_EQ(text_of(folder / "f.toml"), film);
    const Image levels = load_raw_image(folder / "levels.png");
    std::int64_t blue = 0, orange = 0;
    for (std::int64_t i = 0; i < levels.width * levels.height; ++i) {
        const float* const p = &levels.pixels[std::size_t(i * levels.channels)];
        blue += p[2] > p[0];
        orange += p[0] > p[2];
    }
    EXPECT_EQ(blue + orange > 0,
              film.find_first_of("12", film.find("detail_tiles = \"")) != std::string::npos);
    expect_one_line(run({"detail", "f.toml", "--none", "--image", "levels.png"}), 2, "levels.png");
    expect_one_line(run({"detail", "f.toml", "--none", "--image", "levels.doc"}), 4, "levels.doc");
    EXPECT_EQ(text_of(folder / "f.toml"), film) << "what fails changes no scene";
    expect_success(run({"detail", "f.toml", "--splats", "1", "-o", "g.toml"}));
    EXPECT_EQ(text_of(folder / "g.toml"), without);
    expect_one_line(run({"detail", "f.toml", "-o", "g.toml"}), 2, "g.toml");
    expect_one_line(run({"detail", "f.toml", "--splats", "many"}), 2, "--splats");
    expect_one_line(
        run({"--batch", "f.toml", "-f", "1", "--set", "layer.picture.source.structure.detail_tiles=01 2"}), 2,
        "expected rows of 2 tiles as the first, found 1 in '2'");
    const RunResult plane = expect_success(run({"new", "picture.ppm", "-o", "plane.toml", "--as", "plane"}));
    expect_one_line(run({"detail", "plane.toml"}), 2, "expected a layer of bodies");
}

TEST_F(Commands, NewFindsTheAxisOfANebula) {
    write_text(folder / "ring.ppm", pixmap(160, 100, [](int x, int y, int k) {
                   const double r = std::hypot((x - 80) / 50.0, (y - 50) / 30.0);
                   return static_cast<int>(200.0 * std::exp(-20.0 * (r - 0.8) * (r - 0.8))) + 4 - k;
               }));
    expect_success(run({"new", "ring.ppm", "--as", "planetary", "--film"}));
    const std::string text = text_of(folder / "ring.toml");
    EXPECT_HAS(text, "kind = \"axis\", clumps = 1.0, axis_angle = ");
    EXPECT_HAS(text, "# rings about an axis explain 9");
    EXPECT_HAS(text, "[animation]");
    expect_success(
        run({"--batch", "ring.toml", "-f", "1,120", "-o", "ring.####.png", "--resolution", "48x30"}));
}

// The object of a picture comes from a person, from its file's metadata and name, and from its light.
TEST_F(Commands, NewSaysWhatAPictureShowsAndBecauseOfWhat) {
    write_text(folder / "ngc 4594.ppm", small_picture());
    const RunResult named = expect_success(run({"new", "ngc 4594.ppm", "--json"}));
    EXPECT_HAS(named.err, "M 104 in the table of objects is spiral; --as");
    const nlohmann::json report = nlohmann::json::parse(named.out);
    EXPECT_EQ(report["scene"], "ngc 4594.toml");
    EXPECT_EQ(report["object"], "galaxy");
    EXPECT_GT(report["sure"].get<double>(), 0.8);
    EXPECT_EQ(report["names"][0], "M 104");
    EXPECT_GT(report["distance_ly"].get<double>(), 1e7);
    const RunResult by_person = run({"new", "ngc 4594.ppm", "--object", "m57", "--json", "--overwrite"});
    EXPECT_EQ(nlohmann::json::parse(by_person.out)["object"], "planetary") << by_person.out;
    expect_one_line(run({"new", "ngc 4594.ppm", "--object", "Sombrer Galaxy", "-o", "x.toml"}), 2,
                    "did you mean 'Sombrero Galaxy'?");
    expect_one_line(run({"new", "ngc 4594.ppm", "--object", "M 104", "--as", "plane", "-o", "x.toml"}), 2,
                    "--object");
    const std::string avm =
        "<rdf:RDF xmlns:avm=\"http://www.communicatingastronomy.org/avm/1.0/\"><rdf:Description "
        "avm:Type=\"Artwork\" "
        "avm:Subject.Category=\"C.5.1.4\" avm:Distance=\"1000\" avm:Spatial.Scale=\"-0.01\"/></rdf:RDF>";
    write_text(folder / "art.ppm", small_picture() + avm);
    const RunResult art = run({"new", "art.ppm", "--json"});
    EXPECT_HAS(art.err, "AVM says C.5.1.4: elliptical galaxy; --as");
    EXPECT_HAS(art.err, "is no observation: its metadata says 'Artwork'");
    const nlohmann::json measured = nlohmann::json::parse(art.out);
    EXPECT_NEAR(measured["width_ly"].get<double>(),
                1000.0 * measured["width_degrees"].get<double>() * 0.0174532925, 1e-4);
}

// 32 columns of .01 degrees, mirrored and turned; a degree is as long as 1 at a distance of 180 / pi.
TEST_F(Commands, NewSaysHowLargeTheSkyIsAndWritesTheScale) {
    const std::string avm =
        "<rdf:RDF xmlns:avm=\"http://www.communicatingastronomy.org/avm/1.0/\"><rdf:Description "
        "avm:Subject.Category=\"C.5.1.1\" avm:Distance=\"57.29577951308232\" avm:Spatial.Rotation=\"30\">"
        "<avm:Spatial.Scale><rdf:Seq><rdf:li>0.01</rdf:li><rdf:li>0.01</rdf:li></rdf:Seq></avm:Spatial.Scale>"
        "</rdf:Description></rdf:RDF>";
    write_text(folder / "a.ppm", small_picture() + avm);
    const nlohmann::json said = nlohmann::json::parse(run({"new", "a.ppm", "--json"}).out);
    constexpr double width = 0.32;
    EXPECT_NEAR(said["width_degrees"].get<double>(), width, 1e-9);
    EXPECT_NEAR(said["width_ly"].get<double>(), width, 1e-9);
    EXPECT_NEAR(said["north_angle"].get<double>(), -30.0, 1e-9);
    EXPECT_NEAR(info("a.toml").at("light_years_per_unit").get<double>(), 0.1 * width, 1e-6);
    for (const char* shape : {"plane", "relief", "disk", "sphere"}) {
        ASSERT_EQ(run({"new", "a.ppm", "-o", "c.toml", "--overwrite", "--shape", shape}).code, 0);
        const nlohmann::json columns = info("c.toml");
        const bool as_large = shape[0] == 'p' || shape[0] == 'r';
        ASSERT_EQ(columns.contains("light_years_per_unit"), as_large) << shape;
        if (!as_large) continue;
        EXPECT_NEAR(columns["light_years_per_unit"].get<double>(), 0.1 * width, 1e-6);
    }
    write_text(folder / "b.ppm", small_picture());
    ASSERT_EQ(run({"new", "b.ppm"}).code, 0);
    EXPECT_FALSE(info("b.toml").contains("light_years_per_unit"));
}

// In a scene, in its frames, and in a set that is made, converted and read again.
TEST_F(Commands, WhatIsInventedIsSaid) {
    write_text(folder / "gas.ppm", small_picture());
    expect_success(run({"new", "gas.ppm", "--as", "remnant"}));
    const std::string
        begins =
            "measured: light and colours, as the picture's camera sees them; modelled: depths, by two walls",
        margin = "layer.gas.source.structure.margin=0.2";
    EXPECT_EQ(info("gas.toml").at("layers")[0].at("origin").get<std::string>().rfind(begins, 0), 0u);
    expect_success(run({"generate", "gas.toml", "--layer", "gas", "-o", "gas.splats", "--set", margin}));
    const std::string origin = info("gas.splats").at("origin");
    EXPECT_EQ(origin.rfind(begins, 0), 0u);
    EXPECT_HAS(origin, " % of the light)");
    expect_success(run({"convert", "gas.splats", "gas.ply"}));
    EXPECT_EQ(info("gas.ply").at("origin"), origin);
    expect_success(
        run({"--batch", "gas.toml", "-f", "1", "-o", "gas.exr", "--resolution", "64x48", "--set", margin}));
    EXPECT_EQ(info("gas.exr").at("metadata").at("astrosplat/origin"), "gas: " + origin);
    expect_success(batch({"-f", "1", "-o", "splats.exr"}));
    EXPECT_FALSE(info("splats.exr").at("metadata").contains("astrosplat/origin"))
        << "of files that do not say";
}

TEST_F(Commands, GenerateWritesALayer) {
    write_text(folder / "picture.ppm", small_picture());
    expect_success(run({"new", "picture.ppm", "-o", "new.toml", "--shape", "plane"}));
    const std::string layer = info("new.toml").at("layers")[0].at("name");
    const std::string count = "layer." + layer + ".source.count=5000";
    const RunResult result = expect_success(
        run({"generate", "new.toml", "--layer", layer, "--output", "set.splats", "--set", count}));
    EXPECT_HAS(result.out, "set.splats");
    const std::int64_t splats = info("set.splats").at("splats");
    EXPECT_GT(splats, 3000);
    EXPECT_LT(splats, 7000);
    expect_one_line(run({"generate", "new.toml", "--layer", "other", "--output", "other.pda"}), 2, layer);
    expect_one_line(run({"generate", "new.toml", "--layer", layer, "--output", "set.splats"}), 2,
                    "--overwrite");
}

TEST_F(Commands, InfoDescribesEveryKind) {
    const nlohmann::json splats = info("stars.pda");
    EXPECT_EQ(splats.at("kind"), "splats");
    EXPECT_EQ(splats.at("splats"), 300);
    EXPECT_GE(splats.at("bounds").at("lo")[0].get<double>(), -2.0);
    const nlohmann::json scene = info("scene.toml");
    EXPECT_EQ(scene.at("kind"), "scene");
    EXPECT_EQ(scene.at("resolution"), (std::vector<int>{64, 48}));
    EXPECT_EQ(scene.at("layers").size(), 2u);
    expect_success(batch({"-f", "1"}));
    const nlohmann::json frame = info("frames/shot.0001.exr");
    EXPECT_EQ(frame.at("kind"), "image");
    EXPECT_EQ(frame.at("width"), 64);
    EXPECT_EQ(frame.at("frame_hash").get<std::string>().size(), 64u);
    write_text(folder / "square.obj",
               "v 0 0 0\nv 1 0 0\nv 1 2 0\nv 0 2 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n");
    const nlohmann::json mesh = info("square.obj");
    EXPECT_EQ(mesh.at("kind"), "mesh");
    EXPECT_EQ(mesh.at("triangles"), 2);
    EXPECT_EQ(mesh.at("vertices"), 4);
    EXPECT_DOUBLE_EQ(mesh.at("area").get<double>(), 2.0);
    EXPECT_HAS(run({"info", "square.obj"}).out, "triangles: 2");
    write_text(folder / "cam.chan", "1 0 0 5 0 0 0 30\n4 1 0 5 0 0 0 40\n");
    const nlohmann::json camera = info("cam.chan");
    EXPECT_EQ(camera.at("kind"), "camera");
    EXPECT_EQ(camera.at("samples"), 2);
    EXPECT_EQ(camera.at("frames"), nlohmann::json({1.0, 4.0}));
    EXPECT_EQ(camera.at("fov_deg"), nlohmann::json({30.0, 40.0}));
    write_text(folder / "cam.usda", "#usda 1.0\ndef Camera \"c\" { float horizontalApertureOffset = 1 }\n");
    EXPECT_EQ(info("cam.usda").at("projection"), "perspective");
    EXPECT_EQ(info("cam.usda").at("shifted"), true);
    write_text(folder / "none.usda", "#usda 1.0\n");
    expect_one_line(run({"info", "none.usda"}), 2, "expected visible Gaussians");
    write_text(folder / "a.json", "[]");
    expect_one_line(run({"info", "a.json"}), 2, "expected a transforms.json");
    write_text(folder / "move.csv", "frame,camera.fov\n2,30\n9,40\n");
    EXPECT_EQ(info("move.csv").at("kind"), "keyframes");
    EXPECT_EQ(info("move.csv").at("frames"), nlohmann::json({2.0, 9.0}));
    EXPECT_EQ(info("move.csv").at("keys"), nlohmann::json({"camera.fov"}));
    write_text(folder / "noise.bin", "nothing known");
    EXPECT_EQ(run({"info", "noise.bin"}).code, 2);
}

TEST_F(Commands, AWorkingFolderThatIsGoneIsNoFaultOfOurs) {
    const RunResult result =
        run_program({"/bin/bash", "-c",
                     "mkdir gone; cd gone; rmdir ../gone; exec \"$0\" --batch \"$1\" -f 1 -o x.####.exr -q",
                     ASTROSPLAT_PROGRAM, (folder / "scene.toml").string()},
                    {.folder = folder});
    expect_one_line(result, 2, "the working folder is not there any more");
}

TEST_F(Commands, CompareFindsTheDifference) {
    expect_success(batch({"-f", "1,3"}));
    const std::string a = "frames/shot.0001.exr", b = "frames/shot.0003.exr";
    const RunResult same = expect_success(run({"compare", a, a, "--json", "--max-difference", "0"}));
    EXPECT_EQ(nlohmann::json::parse(same.out).at("max_difference"), 0.0);
    EXPECT_EQ(nlohmann::json::parse(same.out).at("identical"), true);
    const RunResult other = run({"compare", a, b, "--json"});
    EXPECT_EQ(other.code, 0) << "without a limit the answer is the figures";
    const double difference = nlohmann::json::parse(other.out).at("max_difference");
    EXPECT_GT(difference, 0.01);
    EXPECT_EQ(run({"compare", a, b, "--max-difference", "0.001"}).code, 3);
    expect_success(run({"compare", a, b, "--max-difference", "1000"}));
    expect_success(batch({"-f", "1", "--resolution", "50%", "-o", "small.exr"}));
    expect_one_line(run({"compare", a, "small.exr"}), 2, "small.exr");
}

TEST_F(Commands, ParametersListEveryKey) {
    const RunResult text = expect_success(run({"parameters"}));
    EXPECT_HAS(text.out, "layer.look.alpha.power");
    const nlohmann::json rows = nlohmann::json::parse(run({"parameters", "--json"}).out);
    ASSERT_GT(rows.size(), 100u);
    const auto density = std::find_if(rows.begin(), rows.end(),
                                      [](const auto& row) { return row.at("key") == "layer.look.density"; });
    ASSERT_NE(density, rows.end());
    EXPECT_EQ(density->at("default"), 1.0);
    EXPECT_EQ(density->at("animated"), "yes");
}

// Input files of every kind at the command line: capitals, pipes, files without a picture, truth in `info`.

using Inputs = Commands;

TEST_F(Inputs, CapitalsInEndings) {
    write_text(folder / "x.OBJ", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    fs::copy_file(folder / "scene.toml", folder / "y.TOML");
    fs::copy_file(folder / "stars.pda", folder / "z.PDA");
    EXPECT_EQ(info("x.OBJ").at("kind"), "mesh");
    EXPECT_EQ(info("y.TOML").at("kind"), "scene");
    EXPECT_EQ(info("z.PDA").at("kind"), "splats");
}

TEST_F(Inputs, InfoNamesOnlyWhatTheFileHolds) {
    write_text(folder / "points.ply",
               "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
               "property float z\nend_header\n0 0 0\n");
    EXPECT_EQ(info("points.ply").at("attributes"), nlohmann::json({"position"}));
    EXPECT_FALSE(info("points.ply").contains("alpha"));
    EXPECT_EQ(info("stars.pda").at("attributes"), nlohmann::json({"position", "color", "alpha", "radius"}));
    EXPECT_TRUE(info("stars.pda").contains("radius"));
}

TEST_F(Inputs, PipesAndDevicesAreRefusedAtOnce) {
    const std::string refused = "it is not a regular file";
    for (const char* name : {"pipe.png", "pipe.obj", "pipe.toml", "pipe.pda", "pipe.fits"}) {
        ASSERT_EQ(mkfifo((folder / name).c_str(), 0600), 0);
        expect_one_line(run({"info", name}), 2, refused);
    }
    expect_one_line(run({"info", "/dev/zero"}), 2, refused);
    expect_one_line(run({"--batch", "pipe.toml"}), 2, refused);
    expect_one_line(run({"--batch", "/dev/zero"}), 2, refused);
    expect_one_line(run({"new", "pipe.png", "-o", "x.toml"}), 2, refused);
    expect_one_line(run({"compare", "pipe.png", "pipe.png"}), 2, refused);
    expect_one_line(run({"convert", "pipe.pda", "x.ply"}), 2, refused);
}

TEST_F(Inputs, AFileThatIsNoPictureMakesNoScene) {
    std::string fits;
    for (std::string card : {"SIMPLE  =                    T", "BITPIX  =                    8",
                             "NAXIS   =                    0", "END"}) {
        card.resize(80, ' ');
        fits += card;
    }
    fits.resize(2880, ' ');
    write_text(folder / "empty.fits", fits);
    write_text(folder / "x.null", "");
    expect_one_line(run({"new", "empty.fits", "-o", "x.toml"}), 2,
                    "expected an HDU with a picture, found none");
    expect_one_line(run({"new", "x.null", "-o", "x.toml"}), 2, "cannot be read as a picture");
    expect_one_line(run({"info", "x.null"}), 2, "cannot be read as a picture");
    expect_one_line(run({"compare", "x.null", "x.null"}), 2, "cannot be read as a picture");
    EXPECT_FALSE(fs::exists(folder / "x.toml"));
}

}  // namespace
}  // namespace astrosplat::test
