// The comparison of the frame, A, with B: the look of a snapshot seen by the same camera, or a reference
// picture. In: the looks to keep, the file to read, requests for B's frame. Out: cards for the widgets, B for
// the display, and the difference in numbers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "edit/snapshots.h"
#include "edit/status.h"
#include "gl/display.h"
#include "gl/objects.h"
#include "viewer/compared_pictures.h"
#include "viewer/view_frame.h"

namespace astrosplat {

/// The snapshots of the open scene: looks with a thumbnail each, kept beside the scene as soon as they are
/// taken. One of them may be B.
class SnapshotList {
  public:
    /// Those kept beside this scene in place of all there are; none of a scene without a file. What cannot be
    /// read becomes a line of `problems`.
    void open(const std::filesystem::path& scene_file, std::vector<std::string>& problems);
    /// The scene lies there from now on, and so do its snapshots. Throws OutputError; they stay in the list.
    void move_to(const std::filesystem::path& scene_file);

    /// Adds a look with its picture, RGBA of display values, top row first. Throws OutputError where it
    /// cannot be kept; it stays in the list.
    void add(StoredLook look, Image picture, std::int64_t splats, double seconds);
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
        Image picture;
        std::int64_t splats = 0;
        double seconds = 0.0;
        std::filesystem::path file;  // empty: not kept
        ImageTexture thumbnail = {};
    };
    StoredView& push(StoredView view);
    void keep(StoredView& view) const;

    std::vector<StoredView> snapshots_;
    std::size_t b_ = no_b;
    std::filesystem::path folder_;  // empty: the scene has no file yet
};

/// An 8-bit picture (RGBA, top row first) as a float one of at most `most` px width, by averaging boxes.
Image thumbnail_of(const std::vector<unsigned char>& rgba, int width, int height, int most);

class Comparison {
  public:
    explicit Comparison(std::shared_ptr<PictureFiles> files) : b_(std::move(files)) {}

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
