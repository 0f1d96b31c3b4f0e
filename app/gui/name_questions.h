// Questions of a file dialog to a disk about the name that is typed, outside of the window's thread
// (disk_question.h). In: the typed text. Out: the rest of it, and its target, when these are known.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

#include "gui/disk_question.h"
#include "gui/file_list.h"

namespace astrosplat {

class NameQuestions {
  public:
    /// Asks for the rest of `typed`, a path in `folder`, and waits a moment for it.
    void complete(const std::string& typed, const std::filesystem::path& folder);
    /// The whole, once, unless something else is typed now.
    std::optional<std::string> completed(const std::string& typed_now);

    /// Asks as look_at (file_list.h), and waits a moment for it.
    void look(const std::filesystem::path& typed, const std::string& ending);
    bool looks() const { return file_.is_open() || found_; }
    /// The result of look(), once.
    std::optional<TypedFile> found();

    /// Something else is typed or wanted now.
    void forget();
    /// Keys are better kept for a while: where they go depends on an answer that is to come.
    bool keys_wait() const;

  private:
    DiskQuestion<std::string> completion_;
    DiskQuestion<TypedFile> file_;
    std::optional<std::string> completed_;
    std::optional<TypedFile> found_;
    std::string completes_;  // is being, or was, completed
    double asked_at_ = 0.0;  // s
};

}  // namespace astrosplat
