// The keys of source.prepare as the options of the command: those that do something, and no others.
#include "edit/command_lines.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "support/errors.h"

namespace astrosplat {
namespace {

using Words = std::vector<std::string>;

SourceParams source_of(std::vector<std::filesystem::path> pictures) {
    SourceParams source;
    source.meshes = {{"plane", std::move(pictures)}};
    return source;
}

TEST(PrepareCommandLine, SaysWhatTheKeysSay) {
    SourceParams source = source_of({"a b.png"});
    EXPECT_EQ(prepare_command(source, "out"),
              (Words{"prepare", "a b.png", "-o", "out", "--stars", "keep", "--lupton", "false"}));
    PrepareParams& prepare = source.texture.prepare;
    prepare.stars = PrepareParams::Stars::remove;
    prepare.threshold = 7.5;
    prepare.background = PrepareParams::Background::plane;
    prepare.ellipse = glm::dvec4(10.0, 20.0, 5.5, 4.0);
    prepare.turn = -30.0;
    prepare.alpha = glm::dvec2(0.0, 0.25);
    prepare.mask = "mask.png";
    EXPECT_EQ(prepare_command(source, "out"), (Words{"prepare",      "a b.png",
                                                     "-o",           "out",
                                                     "--stars",      "remove",
                                                     "--threshold",  "7.5",
                                                     "--background", "plane",
                                                     "--lupton",     "false",
                                                     "--ellipse",    "[10.0, 20.0, 5.5, 4.0]",
                                                     "--turn",       "-30.0",
                                                     "--mask",       "mask.png",
                                                     "--alpha",      "[0.0, 0.25]"}));
}

TEST(PrepareCommandLine, LeavesOutWhatTheCommandWouldRefuse) {
    SourceParams source = source_of({"a.png"});
    source.texture.stretch = TextureSettings::Stretch::log;  // of FITS alone
    source.texture.prepare.threshold = 7.5;                  // no star is removed
    source.texture.prepare.feather = 0.5;                    // nothing is cut
    EXPECT_EQ(prepare_command(source, "out").size(), 8u);
}

TEST(PrepareCommandLine, NamesThreeFilters) {
    SourceParams source = source_of({"r.fits", "g.fits", "b.fits"});
    source.texture.prepare.lupton = true;
    source.texture.prepare.lupton_stretch = 0.5;
    EXPECT_EQ(prepare_command(source, "out"),
              (Words{"prepare", "--r", "r.fits", "--g", "g.fits", "--b", "b.fits", "-o", "out", "--stars",
                     "keep", "--lupton", "true", "--lupton-stretch", "0.5"}));
}

TEST(PrepareCommandLine, NeedsAPicture) {
    EXPECT_EQ(message_of<InputError>([] { prepare_command(source_of({}), "out"); }),
              "source.meshes: expected a picture to prepare, found none");
}

}  // namespace
}  // namespace astrosplat
