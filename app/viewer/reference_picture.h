// The reference picture on the GPU, read in the background. In: the file that is wanted. Out: its display
// values, reduced where it is larger than any view needs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "gl/image_texture.h"
#include "viewer/latest_work.h"

namespace astrosplat {

/// A picture as it is displayed, RGBA, at most `longest_px` long. Throws InputError, Cancelled.
Image read_displayed(const std::filesystem::path& file, std::int64_t longest_px, const Progress& progress);

class ReferencePicture {
  public:
    /// Shows this file, none where it is empty; call it every frame.
    void want(const std::filesystem::path& file);
    /// The file was changed: it is read again.
    void forget() { ++request_.reading; }
    const std::filesystem::path& file() const { return request_.file; }

    bool working() const { return !request_.file.empty() && work_.working(); }
    /// Null while there is none.
    const Image* picture() const { return shown_ ? &shown_->picture : nullptr; }
    unsigned texture() const { return shown_ ? texture_.handle() : 0; }
    const std::string& error() const { return error_; }
    /// Grows whenever the texture's pixels change.
    std::uint64_t version() const { return version_; }

  private:
    struct Request {
        std::filesystem::path file;
        std::uint64_t reading = 0;
        bool operator==(const Request&) const = default;
    };
    struct Found {
        Image picture;
        std::string error;
    };

    Request request_;
    std::string error_;  // one line
    std::shared_ptr<const Found> shown_;
    ImageTexture texture_;
    std::uint64_t version_ = 0;
    LatestWork<Request, Found> work_{[](const Request& request, const Progress& progress) {
        constexpr std::int64_t longest_px = 2560;
        return Found{read_displayed(request.file, longest_px, progress), {}};
    }};
};

}  // namespace astrosplat
