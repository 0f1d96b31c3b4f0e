// Small pictures of picture files, read in the background and kept in memory, so that a person chooses by
// what is seen. In: files as a folder lists them. Out: how they look, or that they cannot be read.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "core/image.h"
#include "core/progress.h"
#include "core/worker.h"
#include "edit/listed_picture.h"

namespace astrosplat {

/// Of a file that cannot be read, nothing but zeros.
struct Thumbnail {
    std::int64_t width = 0, height = 0;  // px of the picture in the file
    std::int64_t small_width = 0, small_height = 0;
    std::vector<std::uint8_t> rgb;  // display values on black, the first row on top
};

/// FITS is stretched as it is where nothing is set, linear light gets the screen's curve. At most `most_px`
/// on its longer side. Throws InputError, Cancelled.
Thumbnail thumbnail_of_file(const std::filesystem::path& file, std::int64_t most_px,
                            const Progress& progress = {});

/// For a texture.
Image to_image(const Thumbnail& thumbnail);

class Thumbnails {
  public:
    /// Keeps up to about `most_bytes` of them, those wanted last.
    explicit Thumbnails(std::int64_t most_px = 144, std::size_t most_bytes = std::size_t{32} << 20);
    ~Thumbnails() { want({}); }

    /// These are read, small files first, unless they are there; a file that is not among them is let go in
    /// the middle. Returns at once.
    void want(const std::vector<ListedPicture>& pictures);
    /// Null while it is not read, or was forgotten.
    std::shared_ptr<const Thumbnail> found(const ListedPicture& picture) const;
    /// Something wanted is not read yet.
    bool working() const;

  private:
    struct Kept {
        std::shared_ptr<const Thumbnail> thumbnail;
        std::uint64_t wanted = 0;  // when it last was, counted in calls of want()
    };
    Worker::Task next_task();
    void read(const ListedPicture& picture, const std::atomic<bool>& cancelled);
    void forget_some();

    std::int64_t most_px_;
    std::size_t most_bytes_;
    std::vector<ListedPicture> wanted_;  // of the last call, small files first
    std::uint64_t calls_ = 0;
    std::map<ListedPicture, Kept> kept_;  // those that are read
    std::optional<ListedPicture> reading_;
    std::shared_ptr<std::atomic<bool>> cancelled_ = std::make_shared<std::atomic<bool>>(false);
    Worker worker_{[this] { return next_task(); }};
};

}  // namespace astrosplat
