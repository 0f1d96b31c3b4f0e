// A splat file that is not to be replaced stays, whatever format is written beside it.
#include <gtest/gtest.h>

#include "core/file.h"
#include "splat_files/splat_file.h"
#include "support/temp_folder.h"
#include "unit/splat_files/file_support.h"

namespace astrosplat {
namespace {

TEST(ExistingSplatFile, IsKeptOrReplaced) {
    const TempFolder folder;
    const SplatSet set = awkward_set(2);
    for (const char* name : {"a.pda", "a.ply", "a.splats"}) {
        const auto file = folder.file(name, "of another program");
        EXPECT_THROW(write_splats({file, Existing::keep}, set), AlreadyExists) << name;
        EXPECT_EQ(read_file(file), "of another program") << name;
        write_splats(file, set);
        EXPECT_EQ(read_splats(file).size(), 2) << name;
    }
}

}  // namespace
}  // namespace astrosplat
