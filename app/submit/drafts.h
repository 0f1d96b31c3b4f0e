// What a submission makes before it is whole, and takes back unless it comes to that.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace astrosplat {

/// A new folder, which goes with all that is in it unless it is kept.
class DraftFolder {
  public:
    /// Below `parent`, which is made where it is missing. Throws OutputError.
    explicit DraftFolder(const std::filesystem::path& parent);
    ~DraftFolder();
    DraftFolder(const DraftFolder&) = delete;
    DraftFolder& operator=(const DraftFolder&) = delete;

    /// The first of 0001, 0002, ... that is free.
    static std::filesystem::path next_name(const std::filesystem::path& parent);

    const std::filesystem::path& path() const { return folder_; }
    void keep() { kept_ = true; }

  private:
    std::filesystem::path folder_;
    bool kept_ = false;
};

/// Jobs in Slurm's queue, which are cancelled unless they are kept.
class DraftJobs {
  public:
    DraftJobs() = default;
    ~DraftJobs();
    DraftJobs(const DraftJobs&) = delete;
    DraftJobs& operator=(const DraftJobs&) = delete;

    /// Calls sbatch with these words in `folder`; the job's number. Throws InputError where sbatch is missing
    /// or refuses; Cancelled.
    std::int64_t submit(const std::filesystem::path& folder, std::vector<std::string> words);
    void keep() { jobs_.clear(); }

  private:
    std::vector<std::int64_t> jobs_;
};

}  // namespace astrosplat
