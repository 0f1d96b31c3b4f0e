// What moves can be believed: six views of the shipped scenes, drawn by the viewer's own session with as many
// dots as hold 24 frames a second on two cores, against their final frames (issue 18, 1).
#include "support/preview_views.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "gl/gl_fixture.h"
#include "support/quiet.h"
#include "support/temp_folder.h"

namespace astrosplat::test {
namespace {

constexpr std::int64_t dots = 60'000;  // fewer than two cores drew at that rate

class PreviewViewsNightly : public GlTest {};

TEST_F(PreviewViewsNightly, MovingPicturesHaveTheLightOfTheFinalOnes) {
    const Quiet quiet;
    const TempFolder folder;
    for (const NamedView& view : preview_views()) {
        SCOPED_TRACE(view.name);
        const ViewTruth truth = measure_truth(view, dots, {folder.path(), 0});
        EXPECT_LE(truth.dots, dots);
        EXPECT_NEAR(truth.light, 1.0, 0.03);
        EXPECT_GT(truth.bright_blocks, 3);
        EXPECT_GE(truth.near, 0.9 * truth.bright_blocks) << "of " << truth.bright_blocks << " blocks";
        EXPECT_NEAR(truth.thickness, 1.0, 0.15);
        fmt::print("{}: light {:+.1f} %, {} of {} blocks, thickness {:+.0f} %\n", view.name,
                   100.0 * (truth.light - 1.0), truth.near, truth.bright_blocks,
                   100.0 * (truth.thickness - 1.0));
    }
}

}  // namespace
}  // namespace astrosplat::test
