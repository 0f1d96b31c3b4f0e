// Background work on the pictures that a view is compared with. Of a layer's own picture the likeness of the
// view from the front, and its preparation, before and after; the reference picture and its alignment to what
// the view shows. In: a scene as it stands and its sets; a layer's source; a file; the view's pixels. Out:
// pictures for the screen, measures for the badge, and a placement.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/image.h"
#include "fidelity/front.h"
#include "gl/objects.h"
#include "prepare/registration.h"
#include "scene/reference_place.h"
#include "scene/scene.h"
#include "sets/kept.h"
#include "splats/splat_set.h"
#include "viewer/background_work.h"

namespace astrosplat {

/// A scene whose view from the front is compared with its picture.
struct FrontRequest {
    Scene scene;                                        // as it stands, without animation
    std::vector<std::shared_ptr<const SplatSet>> sets;  // one a layer; null: the layer is not drawn
    std::uint64_t files = 0;                            // another number: files were changed
    bool operator==(const FrontRequest&) const = default;
};

/// `now` without what no front view depends on: camera, sky, size and exposure of the output.
FrontRequest front_request(Scene now, std::vector<std::shared_ptr<const SplatSet>> sets, std::uint64_t files);

/// A visible layer has a picture that the front view can be compared with.
bool has_front_picture(const Scene& now);
/// A visible layer's look or render settings are not the default ones, which show a picture as it is. Level
/// of detail does not count.
bool front_changed_by_look(const Scene& now);

struct FrontFound {
    FrontFidelity fidelity;
    Image difference;   // display values, RGBA (fidelity/display.h)
    std::string error;  // one line: there is nothing to compare with
};

using FrontCheck = LatestWork<FrontRequest, FrontFound>;
/// Views are at most so wide; pictures that are smaller are compared at their own size. Prepared ones are
/// kept in the cache.
FrontCheck::Work front_check(std::int64_t width_px = 1280, const SetCache& cache = {});

/// A picture to be prepared.
struct PrepareRequest {
    std::vector<std::filesystem::path> files;
    TextureSettings texture;
    std::uint64_t changes = 0;  // another number: files were changed
    bool operator==(const PrepareRequest&) const = default;
};

/// Empty where the layer's first mesh has no picture of the scene's own.
std::optional<PrepareRequest> prepare_request(const LayerParams& layer, std::uint64_t changes);

struct PreparedView {
    Image before, after;  // display values, RGBA, opaque, of one size
    std::vector<std::filesystem::path> files;
    std::int64_t stars = 0;  // removed from the small picture
    std::string error;       // one line: it cannot be prepared
};

/// The pictures' longer side is at most `most_px`. Throws InputError, Cancelled.
PreparedView prepared_view(const PrepareRequest& request, std::int64_t most_px, const Progress& progress);

using PreparePreview = LatestWork<PrepareRequest, PreparedView>;
PreparePreview::Work prepare_preview(std::int64_t most_px = 800);

/// The reference on the GPU, reduced where it is larger than any view needs.
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
    double aspect() const { return double(shown_.size_px().x) / double(shown_.size_px().y); }
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
        Image picture;  // display values, RGBA
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
    CameraParams camera;  // that took the view
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
    bool working() const { return work_.working(); }
    /// Once for each that was begun, when it is done.
    std::shared_ptr<const AlignmentFound> take();
    /// Of the last one that was begun.
    const AlignmentRequest& request() const { return *request_; }

  private:
    using Request = std::shared_ptr<const AlignmentRequest>;
    Request request_;
    LatestWork<Request, AlignmentFound> work_{
        [](const Request& request, const Progress& progress) { return align_reference(*request, progress); }};
};

}  // namespace astrosplat
