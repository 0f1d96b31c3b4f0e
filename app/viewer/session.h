// Everything of the viewer but the window: the document, its sets, the pictures and jobs, brought forward
// once per frame. The window and the screenshot both drive it. Needs a current OpenGL context.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "edit/commands.h"
#include "edit/document.h"
#include "edit/status.h"
#include "edit/view_state.h"
#include "gl/context.h"
#include "gui/gui.h"
#include "viewer/picture.h"
#include "viewer/run_viewer.h"

namespace astrosplat {

struct SessionState;

class Session {
  public:
    /// Opens options.input, or the demo. Throws InputError.
    Session(const ViewerOptions& options, const GlInfo& gl);
    ~Session();

    Document& document();
    ViewState& view();
    const Status& status() const;

    /// Loads what the scene needs and takes what jobs have to say. `now` in seconds.
    void advance(double now);
    /// What mouse and keys did over the viewport, after the widgets drew.
    void navigate(const ViewportInput& input, double now);
    /// Carries them out and empties the list; errors become the message line.
    void carry_out(Commands& commands);
    /// Files dropped on the window.
    void drop(const std::vector<std::filesystem::path>& files);
    /// What they ask for, to be shown to the widgets, which ask about unsaved changes.
    Commands take_dropped();
    /// Draws the viewport's content at its size in px; Status::picture_texture shows it. `hurry`: the final
    /// picture at once.
    void draw(int viewport_width, int viewport_height, double now, bool hurry = false);

    /// Seconds until something is due by itself; 0: draw again at once.
    double next_due(double now) const;
    /// Grows whenever the pixels of Status::picture_texture change.
    std::uint64_t picture_version() const;
    /// Every set is there, or has failed.
    bool loaded() const;
    /// The preview is that of the present camera, look and sets.
    bool preview_exact() const;
    /// The picture is final.
    bool settled() const;
    /// For the message line.
    void say(const std::string& text, bool error = false);
    bool quitting() const;
    std::string title() const;
    /// For screenshots: the preview draws a fixed number of splats instead of one that holds a frame rate;
    /// and where the panels are left out, the whole viewport is the picture, whatever the output's aspect.
    void prepare_screenshot(bool with_panels);

    /// A screenshot that was asked for; the caller reads the window and hands the pixels back.
    std::optional<std::filesystem::path> take_screenshot_request();
    void save_screenshot(const std::filesystem::path& file, int width, int height,
                         const std::vector<unsigned char>& rgba);
    /// Text for the clipboard.
    std::optional<std::string> take_clipboard();

    std::shared_ptr<const RenderedFrame> final_frame() const;
    /// The light of what draw() showed, preview or not, before the view transform; linear, premultiplied.
    Image shown_light() const;
    /// The viewport as shown, 8-bit RGBA, top row first.
    std::vector<unsigned char> shown_pixels() const;

    /// For SIGTERM: writes an autosave, which stays, and throws Cancelled.
    [[noreturn]] void interrupt();
    /// A clean end: autosaves of this session are removed, preferences written.
    void close(int window_width, int window_height);

  private:
    std::unique_ptr<SessionState> state_;
};

}  // namespace astrosplat
