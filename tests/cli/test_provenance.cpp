// Where frames, movies and reports come from, read back by programs that know AVM: exiftool and pyavm.
#include "scene_fixture.h"
#include "support/test_data.h"

namespace astrosplat::test {
namespace {

/// A packet behind a picture's pixels, where no format looks.
std::string packet(const std::string& elements) {
    return "<x:xmpmeta xmlns:x='adobe:ns:meta/'><rdf:RDF "
           "xmlns:rdf='http://www.w3.org/1999/02/22-rdf-syntax-ns#'><rdf:Description rdf:about='' "
           "xmlns:avm='http://www.communicatingastronomy.org/avm/1.0/' "
           "xmlns:dc='http://purl.org/dc/elements/1.1/' "
           "xmlns:photoshop='http://ns.adobe.com/photoshop/1.0/'>" +
           elements + "</rdf:Description></rdf:RDF></x:xmpmeta>";
}

constexpr const char* credit_of_first = "A & <B> ]]> \"Größe\"";

class Provenance : public SceneTest {
  protected:
    Provenance() {
        write_text(
            folder / "first.ppm",
            small_picture() +
                packet(
                    "<photoshop:Credit>A &amp; &lt;B> ]]&gt; \"Größe\"</photoshop:Credit>"
                    "<dc:title><rdf:Alt><rdf:li>A spiral</rdf:li></rdf:Alt></dc:title>"
                    "<dc:subject><rdf:Bag><rdf:li>M 51</rdf:li></rdf:Bag></dc:subject>"
                    "<avm:Type>Observation</avm:Type><avm:Subject.Category>C.5.1.1</avm:Subject.Category>"
                    "<avm:Distance>31000000</avm:Distance><avm:Spatial.Rotation>12</avm:Spatial.Rotation>"
                    "<avm:ReferenceURL>http://example.org/one</avm:ReferenceURL>"
                    "<avm:Facility><rdf:Seq><rdf:li>HST</rdf:li><rdf:li>HST</rdf:li></rdf:Seq></avm:Facility>"
                    "<avm:Spectral.CentralWavelength><rdf:Seq><rdf:li>850</rdf:li><rdf:li>435</rdf:li>"
                    "</rdf:Seq></avm:Spectral.CentralWavelength>"));
        write_text(folder / "second.ppm",
                   small_picture() + packet("<photoshop:Credit>Second</photoshop:Credit>"));
        write_text(folder / "sky.ppm", small_picture() + packet("<photoshop:Credit>Sky</photoshop:Credit>"));
        std::string scene =
            "astrosplat = 1\n[output]\nresolution = [32, 24]\nframes = \"1-2\"\n"
            "[camera]\nposition = [0.0, 0.0, 3.0]\n[environment]\nimage = \"sky.ppm\"\n";
        for (const char* const layer : {"first", "again", "second"})
            scene += fmt::format(
                "[[layer]]\nname = \"{}\"\n[layer.source]\ncount = 500\n[[layer.source.meshes]]\n"
                "mesh = \"plane\"\ntexture = \"{}.ppm\"\n",
                layer, layer == std::string("second") ? "second" : "first");
        write_text(folder / "scene.toml", scene);
    }

    static bool has(const std::string& line) { return std::system((line + " >/dev/null 2>&1").c_str()) == 0; }
    /// What exiftool has to say of a file.
    nlohmann::json exif(const std::string& file) const {
        const RunResult said = expect_success(
            run_program({"/usr/bin/env", "exiftool", "-j", "-struct", "-api", "largefilesupport=1", file},
                        {.folder = folder}));
        return nlohmann::json::parse(said.out).at(0);
    }
    /// Lines "NAME|VALUE" of what pyavm has found in these files. On stdout it prints the packets.
    std::string pyavm(const Words& files) const {
        constexpr const char* script = R"(import sys, pyavm
text = lambda v: v.decode() if isinstance(v, bytes) else str(v)
out = open('found', 'wb')
for file in sys.argv[1:]:
    a = pyavm.AVM.from_image(file)
    said = [('credit', a.Credit), ('title', a.Title), ('type', a.Type), ('id', a.ID), ('url', a.ReferenceURL),
            ('version', a.MetadataVersion), ('rotation', a.Spatial.Rotation)]
    for name, values in [('name', a.Subject.Name), ('category', a.Subject.Category),
                         ('facility', a.Facility), ('wavelength', a.Spectral.CentralWavelength)]:
        said += [(name, value) for value in values]
    for name, value in said:
        out.write(('%s|%s\n' % (name, text(value))).encode())
)";
        expect_success(run_program(joined({"/usr/bin/python3", "-W", "ignore", "-c", script}, files),
                                   {.folder = folder}));
        return text_of(folder / "found");
    }
};

const std::string joined_credits = std::string(credit_of_first) + "; Second; Sky";

TEST_F(Provenance, FramesSayTheirSourcesToExiftool) {
    if (!has("exiftool -ver")) GTEST_SKIP() << "exiftool is not installed (libimage-exiftool-perl)";
    for (const std::string name : {"a.tif", "a.png"}) {
        expect_success(batch({"-f", "1", "-o", name}));
        const nlohmann::json said = exif(name);
        EXPECT_EQ(said.at("Credit"), joined_credits) << name;
        EXPECT_EQ(said.at("Title"), "A spiral");
        EXPECT_EQ(said.at("Subject"), nlohmann::json::array({"M 51"}));
        EXPECT_EQ(said.at("SubjectCategory"), nlohmann::json::array({"C.5.1.1"}));
        EXPECT_EQ(said.at("Type"), "Artwork");
        EXPECT_EQ(said.at("ReferenceURL"), "http://example.org/one");
        EXPECT_EQ(said.at("SpectralCentralWavelength"), nlohmann::json::array({850, 435}));
        EXPECT_FALSE(said.contains("SpatialRotation")) << "which was the picture's, not the frame's";
        const nlohmann::json info = nlohmann::json::parse(run({"info", name, "--json"}).out);
        EXPECT_EQ(said.at("Id"), info.at("frame_hash"));
        EXPECT_EQ(info.at("avm").at("subject").at("category"), "C.5.1.1 (spiral galaxy)");
        EXPECT_EQ(info.at("avm").at("image").at("ID"), info.at("frame_hash"));
    }
}

TEST_F(Provenance, FramesSayTheirSourcesToPyavm) {
    if (!fs::exists("/usr/lib/python3/dist-packages/pyavm"))
        GTEST_SKIP() << "pyavm is not installed (python3-pyavm)";
    std::string expected;
    for (const std::string name : {"a.tif", "a.png", "a.exr"}) {
        expect_success(batch({"-f", "1", "-o", name}));
        const nlohmann::json info = nlohmann::json::parse(run({"info", name, "--json"}).out);
        expected += fmt::format(
            "credit|{}\ntitle|A spiral\ntype|Artwork\nid|{}\nurl|http://example.org/one\nversion|1.2\n"
            "rotation|None\nname|M 51\ncategory|C.5.1.1\nfacility|HST\nfacility|HST\nwavelength|850.0\n"
            "wavelength|435.0\n",
            joined_credits, info.at("frame_hash").get<std::string>());
    }
    EXPECT_EQ(pyavm({"a.tif", "a.png", "a.exr"}), expected);
}

/// By EXIF alone, whose readers a set from the cache does without: it has the credit itself.
TEST_F(Provenance, CreditsOutliveTheCache) {
    if (!has("convert -version") || !has("exiftool -ver"))
        GTEST_SKIP() << "imagemagick or exiftool is missing";
    for (const Words& words : {Words{"convert", "sky.ppm", "third.jpg"},
                               {"exiftool", "-overwrite_original", "-Artist=By EXIF", "third.jpg"}})
        expect_success(run_program(joined({"/usr/bin/env"}, words), {.folder = folder}));
    for (const char* const frame : {"a.exr", "b.exr"}) {
        expect_success(batch({"-f", "1", "-o", frame, "--set",
                              "layer.second.source.meshes=[{ mesh = 'plane', texture = 'third.jpg' }]"}));
        const auto info = nlohmann::json::parse(run({"info", frame, "--json"}).out);
        EXPECT_EQ(info.at("avm").at("creator").at("credit"), std::string(credit_of_first) + "; By EXIF; Sky")
            << frame;
    }
}

/// What is said changes neither pixels nor hashes, and what the scene says comes first.
TEST_F(Provenance, WordsReachNoPixel) {
    expect_success(batch({"-f", "1", "-o", "a.exr"}));
    expect_success(batch({"-f", "1", "-o", "b.exr", "--set", "provenance.credit=Me", "--set",
                          "provenance.type=Simulation", "--set", "provenance.title=Mine"}));
    const auto a = nlohmann::json::parse(run({"info", "a.exr", "--json"}).out),
               b = nlohmann::json::parse(run({"info", "b.exr", "--json"}).out);
    EXPECT_EQ(a.at("frame_hash"), b.at("frame_hash"));
    EXPECT_EQ(a.at("pixel_hash"), b.at("pixel_hash"));
    EXPECT_EQ(b.at("avm").at("creator").at("credit"), "Me");
    EXPECT_EQ(b.at("avm").at("image").at("type"), "Simulation");
    EXPECT_EQ(b.at("avm").at("image").at("title"), "Mine");
    EXPECT_EQ(b.at("avm").at("observation").at("facility"), nlohmann::json::array({"HST", "HST"}));
    EXPECT_FALSE(a.at("metadata").contains("xmp")) << "all of which stands in avm";
    expect_success(batch({"-f", "1", "-o", "a.exr", "--resume", "--set", "provenance.credit=Me"}));
    EXPECT_EQ(nlohmann::json::parse(run({"info", "a.exr", "--json"}).out), a) << "not rendered again";
}

TEST_F(Provenance, MoviesSayWhatTheirFramesSay) {
    if (!has("ffmpeg -version") || !has("ffprobe -version")) GTEST_SKIP() << "ffmpeg is not installed";
    expect_success(batch({"-o", "f.##.png", "--ffmetadata", "words"}));
    for (const std::string movie : {"a.mp4", "a.mov", "a.mkv"}) {
        expect_success(
            run_program({"/usr/bin/env", "ffmpeg", "-nostdin", "-loglevel", "error", "-i", "f.%02d.png", "-f",
                         "ffmetadata", "-i", "words", "-map_metadata", "1", "-pix_fmt", "yuv420p", movie},
                        {.folder = folder}));
        const RunResult probed = expect_success(
            run_program({"/usr/bin/env", "ffprobe", "-v", "error", "-show_format", "-of", "json", movie},
                        {.folder = folder}));
        const auto tags = nlohmann::json::parse(probed.out).at("format").at("tags");
        nlohmann::json said;
        for (const auto& [name, value] : tags.items()) {
            std::string lower = name;
            for (char& c : lower) c = char(std::tolower(c));
            said[lower] = value;
        }
        EXPECT_EQ(said.at("title"), "A spiral") << movie;
        EXPECT_EQ(said.at("artist"), joined_credits);
        EXPECT_EQ(said.at("copyright"), joined_credits);
        const std::string comment = said.at("comment");
        EXPECT_HAS(comment, "image type: Artwork\n");
        EXPECT_HAS(comment, "astrosplat/origin=first: measured: colours");
        EXPECT_HAS(comment, "observation wavelength, nm: 850, 435\n");
        const auto info = nlohmann::json::parse(run({"info", "f.01.png", "--json"}).out);
        EXPECT_HAS(comment, "astrosplat/frameHash=" + info.at("frame_hash").get<std::string>());
        EXPECT_HAS(comment, "astrosplat/hashed=");
        if (has("exiftool -ver") && movie != "a.mkv") {
            EXPECT_EQ(exif(movie).at("Title"), "A spiral");
        }
    }
    const auto frames_made = [&](const std::vector<std::string>& more) {
        fs::remove_all(folder / "again");
        std::vector<std::string> words = {"-o",          "again/f.##.png", "--ffmetadata",
                                          "again/words", "--movie",        "a.mkv"};
        words.insert(words.end(), more.begin(), more.end());
        expect_success(batch(words));
        return names_in("again").size();
    };
    EXPECT_EQ(frames_made({"--resume"}), 0u) << "they would be the same";
    EXPECT_GT(frames_made({}), 1u);
    EXPECT_GT(frames_made({"--resume", "--set", "output.exposure=1"}), 1u);
    EXPECT_GT(frames_made({"--resume", "--set", "output.fps=30"}), 1u);
    write_text(folder / "a.mkv", "damaged");
    EXPECT_GT(frames_made({"--resume"}), 1u);
}

/// Without the sky, which it does not show.
TEST_F(Provenance, TheFidelityPageNamesThoseWhoseLightItShows) {
    write_text(folder / "third.ppm", small_picture() + packet("<photoshop:Credit>Third</photoshop:Credit>"));
    expect_success(run({"fidelity", "scene.toml", "-o", "page.html", "-q", "--reference", "third.ppm"}));
    EXPECT_HAS(text_of(folder / "page.html"),
               "<h2>Credit</h2>\n<p>A &amp; &lt;B&gt; ]]&gt; &quot;Größe&quot;; Second; Third</p>");
}

/// An archive's picture by way of `prepare` and a scene.
TEST_F(Provenance, OfAPublishedPicture) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(images, "images");
    const fs::path picture = images / "opo0328a.jpg";
    expect_success(run({"prepare", picture.string(), "-o", "ready", "--stars", "keep"}));
    const auto given = nlohmann::json::parse(run({"info", picture.string(), "--json"}).out).at("avm");
    EXPECT_EQ(given.at("publisher").at("name"), "ESA/Hubble");
    const auto kept = nlohmann::json::parse(run({"info", "ready/picture.exr", "--json"}).out).at("avm");
    for (const char* const group : {"observation", "subject"}) EXPECT_EQ(kept.at(group), given.at(group));
    EXPECT_EQ(kept.at("image").at("web page"), given.at("image").at("web page"));
    EXPECT_EQ(kept.at("creator").at("credit"), given.at("creator").at("credit"));
    EXPECT_TRUE(kept.contains("spatial"));
}

}  // namespace
}  // namespace astrosplat::test
