// The desktop's own file dialog, where zenity or kdialog is installed: started beside the window, whose loop
// goes on.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "gui/gui.h"
#include "viewer/child_process.h"

namespace astrosplat {

class NativeChooser {
  public:
    /// Shows the dialog; false where there is none or one is open already.
    bool open(const FileQuery& request);
    bool is_open() const { return process_ != nullptr; }
    /// Once it was closed: the file, or nothing inside when the person thought better of it.
    std::optional<std::optional<std::filesystem::path>> take_answer();

  private:
    std::unique_ptr<ChildProcess> process_;
    std::string output_;
    FileQuery request_;
};

}  // namespace astrosplat
