// A folder for files that nobody is to see, where the system keeps such; removed with all that is in it.
#pragma once

#include <filesystem>

namespace astrosplat {

/// Makes one that stays. Throws OutputError when there can be none.
std::filesystem::path make_temporary_folder();

class TemporaryFolder {
  public:
    /// Throws OutputError when there can be none.
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

}  // namespace astrosplat
