// What the frame, A, is compared with: the look of a snapshot seen by the same camera, or a reference
// picture. In: the looks to keep, the file to read, requests for B's frame. Out: what the display shows
// beside A.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "edit/snapshots.h"
#include "edit/status.h"
#include "gl/display.h"
#include "gl/image_texture.h"
#include "viewer/reference_picture.h"
#include "viewer/view_frame.h"

namespace astrosplat {

/// An 8-bit picture (RGBA, top row first) as a float one of at most `most` px width, by averaging boxes.
Image thumbnail_of(const std::vector<unsigned char>& rgba, int width, int height, int most);

class Comparison {
  public:
    explicit Comparison(std::shared_ptr<PictureFiles> files) : b_(std::move(files)) {}

    /// Keeps the look as it is, with a thumbnail of what `display` shows at this size in px and the facts of
    /// that picture. The oldest of more than 24 goes.
    void take_snapshot(const Document& document, const ViewState& view, const Display& display,
                       glm::ivec2 size_px, const ViewFrameStatus& frame);
    void delete_snapshot(std::size_t index);
    void clear_snapshots();
    /// Null where there is none of this number.
    const StoredLook* snapshot(std::size_t index) const;
    /// Makes a snapshot B; numbers that there are not change nothing.
    void set_b(std::size_t index);
    void set_b_to_last() { set_b(snapshots_.size() - 1); }

    /// Chooses the reference of the view, reads its picture in the background, and says in `status` which it
    /// is. Call it every frame.
    void find_reference(const Scene& scene, const ViewState& view, Status& status);
    ReferencePicture& reference() { return reference_; }
    const ReferencePicture& reference() const { return reference_; }

    /// How what is compared with is made: B's request for any scene as A's is made, how it is drawn; and the
    /// frame that the reference lies over, px of the display.
    struct ViewOfB {
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
    void fill(Status& status) const;

  private:
    /// A stored look with a thumbnail of it.
    struct StoredView {
        StoredLook look;
        ImageTexture thumbnail;
        float aspect = 1.0f;
        std::int64_t splats = 0;
        double seconds = 0.0;
    };

    ViewFrame b_;
    std::vector<StoredView> snapshots_;
    int b_snapshot_ = -1, snapshots_taken_ = 0;
    bool comparing_ = false;  // the last show() showed more than A
    bool blink_shows_other_ = false;
    ReferencePicture reference_;
};

/// A texture as the widgets name it.
inline void* to_handle(unsigned texture) {
    return reinterpret_cast<void*>(static_cast<std::uintptr_t>(texture));
}

}  // namespace astrosplat
