// Files to read from, with the same one line for every reader when that cannot be. Only regular files: a pipe
// or a device may never end. And folders: of a person's own files of the program, as the XDG base directory
// specification has it; of the files that come with the program (demo scenes, looks, pictures);
// temporary ones.
#pragma once

#include "core/progress.h"

namespace astrosplat {

/// An open file, closed by the destructor.
class InputFile {
  public:
    /// Throws InputError "FILE: cannot be read: REASON" (missing, a folder, no permission, no regular file).
    explicit InputFile(const fs::path& file);
    ~InputFile();
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;

    int descriptor() const { return descriptor_; }
    std::int64_t size() const { return size_; }  // bytes when it was opened
    /// The next bytes, at most `size` of them; 0 at the end. Throws InputError.
    std::size_t read(char* out, std::size_t size);

  private:
    fs::path file_;
    int descriptor_ = -1;
    std::int64_t size_ = 0;
};

/// Throws InputError like InputFile: for files that a library opens itself.
void require_readable(const fs::path& file);

/// All bytes of a file. Throws InputError as InputFile does, and when it is larger than the
/// memory left; Cancelled.
std::string read_file(const fs::path& file, const Progress& progress = {});

/// Entries of a folder, sorted by name; nothing where it cannot be read. (libstdc++'s own iterator ends the
/// program where memory runs out.)
std::vector<fs::path> entries_of(const fs::path& folder);

/// When and how large a file was, and which one has the name: replacing it by renaming another changes that
/// alone. All 0 where there is no file, or none that may be looked at.
struct FileStamp {
    std::int64_t seconds = 0, nanoseconds = 0;  // of its last change
    std::int64_t size = 0;                      // bytes
    std::uint64_t device = 0, inode = 0;
    bool operator==(const FileStamp&) const = default;
};
FileStamp stamp_of(const fs::path& file);

/// At most the first `size` bytes, such as a format's magic bytes; empty where the file cannot be read.
std::string read_beginning(const fs::path& file, std::size_t size);

/// $XDG_STATE_HOME/astrosplat, else ~/.local/state/astrosplat; empty without a home.
fs::path state_folder();
/// $XDG_CONFIG_HOME/astrosplat, else ~/.config/astrosplat; empty without a home.
fs::path config_folder();
/// $XDG_DATA_HOME/astrosplat, else ~/.local/share/astrosplat; empty without a home.
fs::path data_folder();
/// $XDG_CACHE_HOME/astrosplat, else ~/.cache/astrosplat; empty without a home.
fs::path cache_folder();

/// Creates it where it is missing. Throws OutputError.
void make_folder(const fs::path& folder);

/// Folder `name` ("looks", "scenes") of the assets installed beside the program, else of the source tree that
/// it was built from; empty where neither is there.
fs::path assets_folder(const std::string& name);

/// $XDG_DATA_HOME/astrosplat/NAME, else ~/.local/share/astrosplat/NAME: a person's own; empty without a home.
fs::path own_assets_folder(const std::string& name);

/// The TOML file that a short name means: where there is no file `wanted` and it has no ending, NAME.toml
/// beside it, in the person's own folder, or among the assets, whichever is there first; else `wanted`.
fs::path find_by_name(const std::string& folder, const fs::path& wanted);

/// Short names that are known in `folder` apart from those next to a scene, sorted.
std::vector<std::string> names_in(const std::string& folder);

/// Makes a folder where the system keeps temporary files; it stays. Throws OutputError when there
/// can be none.
fs::path make_temporary_folder();

/// Such a folder, removed with all that is in it.
class TemporaryFolder {
  public:
    /// Throws OutputError when there can be none.
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const fs::path& path() const { return path_; }

  private:
    fs::path path_;
};

}  // namespace astrosplat
