// The comparison of the frame, A, with other images: the look of a snapshot seen by the same camera, B;
// the reference picture and its alignment to what the view shows; a layer's own picture, before and after
// its preparation, and the likeness of the view from the front to it. In: a scene as it stands and its sets;
// looks to keep; files. Out: images for the display, cards and measures for the widgets, a placement.
#pragma once

#include "core/image.h"
#include "edit/kept_files.h"
#include "edit/status.h"
#include "fidelity/front.h"
#include "gl/display.h"
#include "gl/objects.h"
#include "prepare/registration.h"
#include "scene/reference_place.h"
#include "scene/scene.h"
#include "sets/kept.h"
#include "splats/splat_set.h"
#include "viewer/background_work.h"
#include "viewer/view_frame.h"

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
/// What of the visible layers' look and render settings is not as by default, which shows a picture as it is:
/// "gain, saturation". Level of detail does not count. Empty: nothing.
std::string front_changed_by(const Scene& now);

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
    std::vector<fs::path> files;
    TextureSettings texture;
    std::uint64_t changes = 0;  // another number: files were changed
    bool operator==(const PrepareRequest&) const = default;
};

/// Empty where the layer's first mesh has no picture of the scene's own.
std::optional<PrepareRequest> prepare_request(const LayerParams& layer, std::uint64_t changes);

struct PreparedView {
    Image before, after;  // display values, RGBA, opaque, of one size
    std::vector<fs::path> files;
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
    void want(const fs::path& file);
    /// The file was changed: it is read again.
    void forget() { ++request_.reading; }
    const fs::path& file() const { return request_.file; }

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
        fs::path file;
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
    UploadedImage<Found> shown_;
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

/// The snapshots of the open scene: looks with a thumbnail each, kept beside the scene as soon as they are
/// taken. One of them may be B.
class SnapshotList {
  public:
    /// Those kept beside this scene in place of all there are; none of a scene without a file. What cannot be
    /// read becomes a line of `problems`.
    void open(const fs::path& scene_file, std::vector<std::string>& problems);
    /// The scene lies there from now on, and so do its snapshots. Throws OutputError; they stay in the list.
    void move_to(const fs::path& scene_file);

    /// Adds a look with its image, RGBA of display values, top row first. Throws OutputError where it
    /// cannot be kept; it stays in the list.
    void add(StoredLook look, Image image);
    /// Throw InputError and OutputError; the list is then as before.
    void rename(std::size_t index, const std::string& name);
    void remove(std::size_t index);

    std::size_t size() const { return snapshots_.size(); }
    /// Null: there is none with this number.
    const StoredLook* look(std::size_t index) const {
        return index < snapshots_.size() ? &snapshots_[index].look : nullptr;
    }
    /// A number that there is not changes nothing.
    void set_b(std::size_t index) {
        if (index < snapshots_.size()) b_ = index;
    }
    /// Null: none is B.
    const StoredLook* b() const { return look(b_); }
    /// "Look 3", which none has yet.
    std::string next_name() const;
    void fill(Status& status) const;

  private:
    static constexpr std::size_t no_b = ~std::size_t{0};
    struct StoredView {
        StoredLook look;
        Image image;
        ImageTexture thumbnail = {};
    };
    StoredView& push(StoredLook look, Image image);
    void keep(StoredView& view) const;

    std::vector<StoredView> snapshots_;
    std::size_t b_ = no_b;
    fs::path folder_;  // empty: the scene has no file yet
};

/// An 8-bit image (RGBA, top row first) as a float one of at most `most` px width, by averaging boxes.
Image thumbnail_of(const std::vector<unsigned char>& rgba, int width, int height, int most);

class Comparison {
  public:
    Comparison(std::shared_ptr<PictureFiles> files, const CardChoice& card, std::shared_ptr<FinalFrames> kept)
        : b_(std::move(files), card, std::move(kept)) {}

    /// Chooses the reference of the view, reads its picture in the background, and says in `status` which it
    /// is. Call it every frame.
    void find_reference(const Scene& scene, const ViewState& view, Status& status);
    ReferencePicture& reference() { return reference_; }
    const ReferencePicture& reference() const { return reference_; }

    /// How what is compared with is made: B's request for any scene as A's is made, how it is drawn; and the
    /// frame that the reference lies over, px of the display.
    struct ViewOfB {
        const StoredLook* look = nullptr;  // null: there is none
        std::function<ViewRequest(const Scene&)> request_for;
        PreviewChoice choice;
        bool may_settle = false;
        double now = 0.0;  // seconds
        FrameOnScreen frame;
    };
    /// Puts B or the reference beside A in `shown`, as `view` compares them.
    void show(const Scene& scene, const ViewState& view, const ViewOfB& how, DisplaySettings& shown);
    /// Of blinking: the other is shown now, not A.
    bool blink_shows_other() const { return blink_shows_other_; }

    /// B's frame is on its way.
    bool waiting() const { return comparing_ && b_.waiting(); }
    /// B's status while it is refined; else null.
    const ViewFrameStatus* refining() const;
    /// Grows whenever the pixels of B or the reference change.
    std::uint64_t version() const { return b_.version() + reference_.version(); }

  private:
    ViewFrame b_;
    bool comparing_ = false;  // the last show() showed more than A
    bool blink_shows_other_ = false;
    ReferencePicture reference_;
};

/// Of display values (RGBA of one size), where b's alpha is 1; none where that is nowhere.
std::optional<DifferenceStatus> difference_of(const Image& a, const Image& b);

/// The numbers beside a difference that is shown, measured again a few times a second while it changes.
class DifferenceMeter {
  public:
    /// `shown` as `display` draws it on a target of this size; `now` in seconds.
    void measure(Display& display, const DisplaySettings& shown, glm::ivec2 target_px, double now);
    void clear() { *this = {}; }
    const std::optional<DifferenceStatus>& found() const { return found_; }
    /// The frame that is shown has not been measured yet.
    bool waiting() const { return waiting_; }

  private:
    DisplaySettings measured_;
    glm::ivec2 target_px_{0};
    double measured_at_ = -1.0;
    bool waiting_ = false;
    std::optional<DifferenceStatus> found_;
};

}  // namespace astrosplat
