// Views of a configuration against their closed forms, the names it has to choose from, and the one line for
// each way in which a name or a file can be wrong.
#include "ocio/display_transform.h"

#include "support/color_config.h"
#include "support/test.h"

namespace astrosplat {
namespace {

class DisplayTransformTest : public testing::Test {
  protected:
    TempFolder folder_;
    fs::path config_ = test::write_color_config(folder_.path());

    std::array<float, 3> shown(const OcioParams& params, float r, float g, float b) const {
        std::array<float, 3> rgb{r, g, b};
        DisplayTransform(params).apply(rgb.data(), 1);
        return rgb;
    }
    static std::string error_of(const OcioParams& params) {
        return ERROR_OF(DisplayTransform transform(params));
    }
};

TEST_F(DisplayTransformTest, ViewsAreTheirClosedForms) {
    for (const std::array<double, 3> light :
         {std::array{0.0, 0.0, 0.0}, {0.18, 0.5, 0.02}, {4.0, 0.3, 0.9}}) {
        const auto [r, g, b] = light;
        const std::array<double, 3> film = test::film(r, g, b);
        const std::array<float, 3> got = shown({config_, "", "", ""}, float(r), float(g), float(b)),
                                   plain =
                                       shown({config_, "Screen", "Plain", ""}, float(r), float(g), float(b)),
                                   negative = shown({config_, "Screen", "Negative", ""}, float(r), float(g),
                                                    float(b));
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_NEAR(got[c], film[c], 1e-6) << r << " " << c;
            EXPECT_EQ(plain[c], std::fmin(float(light[c]), 1.0f));
            EXPECT_NEAR(negative[c], std::fmax(1.0 - light[c], 0.0), 1e-6);
        }
    }
}

TEST_F(DisplayTransformTest, ValuesStayInRange) {
    const float odd[] = {-1.0f, 1e30f, std::numeric_limits<float>::infinity(),
                         std::numeric_limits<float>::quiet_NaN()};
    for (const float x : odd)
        for (const float value : shown({config_, "", "Plain", ""}, x, x, x))
            EXPECT_TRUE(value >= 0.0f && value <= 1.0f) << x;
}

TEST_F(DisplayTransformTest, TheSpaceOfLightIsTheNamedOne) {
    EXPECT_EQ(shown({config_, "", "Plain", "doubled"}, 0.25f, 0.1f, 0.0f), (std::array{0.5f, 0.2f, 0.0f}));
    EXPECT_EQ(DisplayTransform({config_, "", "", ""}).space(), "scene_linear");
    std::string text = test::color_config_text;
    text.replace(text.find("name: doubled"), 13, "name: lin_rec709");
    std::ofstream(config_) << text;
    EXPECT_EQ(DisplayTransform({config_, "", "", ""}).space(), "lin_rec709");
}

// The primaries of Rec. 709 and white in ACES2065-1, as colour-science's tables have them.
TEST_F(DisplayTransformTest, WithoutANameItEntersThroughAces) {
    std::string text = test::color_config_text;
    text.replace(text.find("  scene_linear: light"), 21, "  aces_interchange: light");
    std::ofstream(config_) << text;
    const OcioParams params{config_, "", "Plain", ""};
    EXPECT_EQ(DisplayTransform(params).space(), "aces_interchange");
    const std::array<float, 3> red = shown(params, 1, 0, 0), white = shown(params, 0.5f, 0.5f, 0.5f);
    const double expected[3] = {0.4396, 0.0898, 0.0175};
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(red[c], expected[c], 1e-3) << c;
        EXPECT_NEAR(white[c], 0.5, 1e-6);
    }
}

TEST_F(DisplayTransformTest, NamesToChooseFrom) {
    const ColorConfig config = read_color_config(config_);
    EXPECT_EQ(config.default_display, "Screen");
    ASSERT_EQ(config.displays.size(), 2u);
    EXPECT_EQ(config.displays[0].views, (std::vector<std::string>{"Film", "Plain", "Negative"}));
    EXPECT_EQ(config.displays[0].default_view, "Film");
    EXPECT_EQ(config.displays[1].name, "Projector");
}

TEST_F(DisplayTransformTest, TheEnvironmentNamesAConfiguration) {
    const Variable ocio("OCIO", config_.c_str());
    const DisplayTransform transform({"", "Projector", "", ""});
    EXPECT_EQ(transform.view(), "Pure");
    EXPECT_EQ(transform.files(), std::vector{config_});
    EXPECT_FALSE(OcioParams().wanted()) << "a scene that says nothing keeps its own views";
}

TEST_F(DisplayTransformTest, TablesAreFilesItDependsOn) {
    const DisplayTransform transform({config_, "", "Negative", ""});
    EXPECT_EQ(transform.files(), (std::vector{config_, folder_.path() / "negative.cube"}));
}

TEST_F(DisplayTransformTest, IsMadeAnewWhenAFileOfItChanges) {
    const OcioParams params{config_, "", "Negative", ""};
    const auto first = display_transform(params);
    EXPECT_EQ(display_transform(params), first);
    std::ofstream table(folder_.path() / "negative.cube");
    table << "LUT_3D_SIZE 2\n";
    for (int i = 0; i < 8; ++i) table << "0.25 0.25 0.25\n";
    table.close();
    const auto second = display_transform(params);
    EXPECT_NE(second, first);
    float rgb[3] = {0, 0, 0};
    second->apply(rgb, 1);
    EXPECT_EQ(rgb[0], 0.25f);
}

TEST_F(DisplayTransformTest, OneLineForEveryMistake) {
    const Variable ocio("OCIO", "");
    const std::string file = config_.string();
    EXPECT_EQ(error_of({config_, "Screan", "", ""}),
              "output.ocio.display: expected Screen or Projector of " + file + ", found 'Screan'");
    EXPECT_EQ(error_of({config_, "Projector", "Film", ""}),
              "output.ocio.view: expected Pure of " + file + ", found 'Film'");
    EXPECT_EQ(error_of({config_, "", "", "lin"}),
              "output.ocio.space: expected a colour space of " + file + ", found 'lin'");
    EXPECT_EQ(error_of({"", "Screen", "", ""}),
              "output.ocio.config: expected a file, as the environment's OCIO names none, found none");
    const fs::path missing = folder_.path() / "missing.ocio";
    EXPECT_EQ(error_of({missing, "", "", ""}),
              missing.string() + ": cannot be read: No such file or directory");
    std::ofstream(config_) << "no configuration: [\n";
    const std::string broken = error_of({config_, "", "", ""});
    EXPECT_EQ(broken.find(file + ": expected a configuration of OpenColorIO, found "), 0u) << broken;
    EXPECT_EQ(broken.find('\n'), std::string::npos) << broken;
    fs::remove(folder_.path() / "negative.cube");
    test::write_color_config(folder_.path());
    fs::remove(folder_.path() / "negative.cube");
    const std::string table = error_of({config_, "", "Negative", ""});
    EXPECT_EQ(table.find(file + ": expected a view 'Negative' that can be made, found "), 0u) << table;
    EXPECT_HAS(table, "negative.cube");
}

TEST_F(DisplayTransformTest, ShadersGetTheSameTables) {
    const GlslTransform negative = DisplayTransform({config_, "", "Negative", ""}).glsl();
    EXPECT_HAS(negative.text, "vec4 ocio_display(vec4");
    ASSERT_EQ(negative.tables.size(), 1u);
    EXPECT_EQ(negative.tables[0].dimensions, 3);
    EXPECT_EQ(negative.tables[0].values.size(), std::size_t{3 * 33 * 33 * 33});
    EXPECT_HAS(negative.text, negative.tables[0].sampler);
    EXPECT_TRUE(DisplayTransform({config_, "", "Film", ""}).glsl().tables.empty());
}

}  // namespace
}  // namespace astrosplat
