// Time and bytes that a rendering will take, for the dialog that asks for it: the program's own --dry-run of
// the scene as it stands, in the background. In: the dialog's task and the document. Out: one line.
#pragma once

#include "viewer/render_queue.h"

namespace astrosplat {

/// Of what --dry-run has printed: "About 00:01:36 and 744 MB in all; 12 of 240 frames are there already".
/// Empty where nothing of it can be read.
std::string estimate_text(const std::vector<std::string>& lines);

class RenderEstimate {
  public:
    /// Begins once a task and a document have stood for a moment, in place of what was asked before; call it
    /// every frame. `now` in seconds. Throws OutputError, InputError.
    void want(const RenderQueue& jobs, const RenderTask& task, const Document& document, double now);
    /// Nothing is wanted; call it every frame, too.
    void stop();
    bool working() const { return waits_ || run_; }
    /// One line, also of why it cannot be rendered; empty: nothing is known.
    const std::string& text() const { return text_; }

  private:
    std::optional<std::pair<std::uint64_t, RenderTask>> asked_;  // revision of the document
    bool waits_ = false;
    double since_ = 0.0;  // s
    std::unique_ptr<RenderJob> run_;
    std::vector<std::unique_ptr<RenderJob>> leaving_;  // asked to end, and not waited for
    std::string text_;
};

}  // namespace astrosplat
