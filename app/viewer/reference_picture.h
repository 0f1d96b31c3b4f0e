// The reference picture on the GPU, and its alignment to what the view shows, both worked out in the
// background. In: the file that is wanted; the view's pixels. Out: display values, reduced where they are
// larger than any view needs; a placement, or none where the two are not alike.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "gl/image_texture.h"
#include "prepare/registration.h"
#include "scene/reference_place.h"
#include "viewer/background_work.h"

namespace astrosplat {

class ReferencePicture {
  public:
    /// Shows this file, none where it is empty; call it every frame.
    void want(const std::filesystem::path& file);
    /// The file was changed: it is read again.
    void forget() { ++request_.reading; }
    const std::filesystem::path& file() const { return request_.file; }

    bool working() const { return !request_.file.empty() && work_.working(); }
    /// Null while there is none.
    const Image* picture() const { return shown_.found() ? &shown_.found()->picture : nullptr; }
    unsigned texture() const { return shown_.texture(); }
    double aspect() const {
        return static_cast<double>(shown_.size_px().x) / static_cast<double>(shown_.size_px().y);
    }
    const std::string& error() const { return error_; }
    /// Grows whenever the texture's pixels change.
    std::uint64_t version() const { return shown_.version(); }

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

    /// Throws InputError, Cancelled.
    static Found read(const Request& request, const Progress& progress);

    Request request_;
    std::string error_;  // one line
    ShownPicture<Found> shown_;
    LatestWork<Request, Found> work_{read};
};

/// The inputs of an alignment: the view's pixels, and the place of the frame among them.
struct AlignmentRequest {
    Image view, picture;  // display values, RGBA, top row first
    FrameOnScreen frame;  // px of `view`
    ReferenceParams reference;
    CameraParams camera;       // that took the view
    std::uint64_t number = 0;  // differs from request to request
    bool operator==(const AlignmentRequest& other) const { return number == other.number; }
};

struct AlignmentFound {
    std::optional<ReferenceParams> reference;  // placed; none: nothing in the view is like it
    double likeness = 0.0;
    std::string error;
};

/// Works it out here and now. Throws Cancelled.
AlignmentFound align_reference(const AlignmentRequest& request, const Progress& progress = {});

class ReferenceAlignment {
  public:
    /// In place of one that is under way.
    void begin(AlignmentRequest request);
    bool working() const { return request_ && work_.working(); }
    /// Once for each that was begun, when it is done.
    std::shared_ptr<const AlignmentFound> take();
    /// Of the last one that was begun.
    const AlignmentRequest& request() const { return *request_; }

  private:
    std::optional<AlignmentRequest> request_;
    bool taken_ = true;
    std::uint64_t begun_ = 0;
    LatestWork<AlignmentRequest, AlignmentFound> work_{align_reference};
};

}  // namespace astrosplat
