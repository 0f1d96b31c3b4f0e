// Every splat format of the table has a reader, and a writer where it says so; what is written is read again.
// A new row of core/file_format.cpp is tested as soon as it is there.
#include "core/file_format.h"
#include "splat_files/splat_file.h"
#include "unit/splat_files/file_support.h"

namespace astrosplat {
namespace {

class SplatFormats : public SplatFileTest {
  protected:
    static std::vector<std::string> endings(FileUse use) { return endings_of({FileKind::splats}, use); }
};

TEST_F(SplatFormats, HaveReaders) {
    for (const std::string& ending : endings(FileUse::read)) {
        const auto file = write("empty" + ending, "");
        for (const std::string& error : {error_of(file, [](const auto& f) { read_splats(f); }),
                                         error_of(file, [](const auto& f) { splat_attributes(f); })}) {
            EXPECT_NE(error, "") << ending;  // it is no such file
            EXPECT_EQ(error.find("one of the endings"), std::string::npos) << ending << ": " << error;
        }
    }
}

TEST_F(SplatFormats, AreReadAsTheyWereWritten) {
    const SplatSet set = awkward_set(300);
    for (const std::string& ending : endings(FileUse::written)) {
        const auto file = path("a" + ending);
        write_splats({file}, set);
        SplatSet read = read_splats(file);
        sort_by_id(read);
        SCOPED_TRACE(ending);
        expect_same_splats(read, set);
    }
}

}  // namespace
}  // namespace astrosplat
