// One picture of the viewport: the preview while something changes, then the final picture, tile by tile,
// once the hand rests (DESIGN 10). In: what is to be seen. Out: a texture, and how far it is.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "edit/status.h"
#include "edit/view_state.h"
#include "gl/display.h"
#include "gl/preview.h"
#include "scene/scene.h"
#include "viewer/cpu_preview.h"
#include "viewer/final_picture.h"
#include "viewer/preview_budget.h"
#include "viewer/set_loader.h"

namespace astrosplat {

/// What is to be seen. Equal requests show equal pictures.
struct PictureRequest {
    Scene scene;  // as it stands at the frame, with the view's camera; layers that are not to be seen are
                  // invisible
    std::vector<std::shared_ptr<const LoadedLayer>> layers;  // as in the scene; null: not loaded
    Bounds box;                                              // of the visible layers, world space
    int width = 0, height = 0;                               // px of the whole picture
    std::uint64_t files = 0;                                 // another number: pictures were changed on disk
    Region region;                                           // the part to be seen; empty: all
    bool operator==(const PictureRequest& other) const;
};

/// The camera of a request, for its whole picture. Throws InputError.
Camera camera_of(const PictureRequest& request);

/// How previews are drawn.
struct PreviewChoice {
    bool opengl = false;
    float share = 0.0f;       // of every layer; 0: sized by the frame rate
    std::int64_t splats = 0;  // with share 0: this many in all, whatever the frame rate; 0: by it
    double target_ms = 25.0;  // of one preview
};

/// Pictures that several views share: thickness maps and environments, by file.
class PictureFiles;

class ViewPicture {
  public:
    explicit ViewPicture(std::shared_ptr<PictureFiles> files);
    ~ViewPicture();

    /// Shows `request`: draws a preview where it differs from the last one, else goes on towards the final
    /// picture once nothing has changed for 0.3 s (`settle`; `hurry`: at once). `now` in seconds.
    void show(const PictureRequest& request, const PreviewChoice& choice, bool settle, double now,
              bool hurry = false);
    /// Stops the work on the final picture; show() begins it again.
    void stop();

    unsigned texture() const;
    /// Grows whenever the texture's pixels change.
    std::uint64_t version() const;
    const PictureStatus& status() const;
    /// show() should be called again soon although nobody did anything.
    bool waiting() const;
    /// Preview splats of each layer in the last preview.
    const std::vector<std::int64_t>& shown() const;
    /// Splats of each layer that its look keeps, estimated from the last preview; below 0: not known.
    const std::vector<std::int64_t>& kept() const;
    /// The preview is that of the present request, in order.
    bool exact() const;
    /// Seconds until the final picture may begin.
    double due(double now) const;
    /// Linear RGBA as shown, region-sized; null while only the GPU has it.
    const Image* pixels() const;
    /// The same, read back from the GPU where need be.
    Image read() const;
    /// The final picture, when status says so.
    std::shared_ptr<const RenderedFrame> final_frame() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

std::shared_ptr<PictureFiles> make_picture_files();
/// Reads these again when they are next asked for.
void forget(PictureFiles& pictures, const std::vector<std::filesystem::path>& files);

}  // namespace astrosplat
