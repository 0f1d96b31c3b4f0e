#include "viewer/native_chooser.h"

#include "core/error.h"
#include "viewer/programs.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

/// "*.toml *.exr", for filters.
std::string patterns(const FileQuery& request) {
    std::string text;
    for (const std::string& extension : request.extensions) text += (text.empty() ? "*" : " *") + extension;
    return text;
}

std::vector<std::string> zenity(const FileQuery& request) {
    std::vector<std::string> words = {"zenity", "--file-selection", "--title=" + request.title,
                                      "--filename=" + (request.folder / request.name).string()};
    if (request.saving) words.insert(words.end(), {"--save", "--confirm-overwrite"});
    if (!request.extensions.empty())
        words.push_back("--file-filter=" + request.kind + " | " + patterns(request));
    words.push_back("--file-filter=All files | *");
    return words;
}

std::vector<std::string> kdialog(const FileQuery& request) {
    std::vector<std::string> words = {"kdialog", "--title", request.title,
                                      request.saving ? "--getsavefilename" : "--getopenfilename",
                                      (request.folder / request.name).string()};
    if (!request.extensions.empty()) words.push_back(request.kind + " (" + patterns(request) + ")");
    return words;
}

}  // namespace

bool NativeChooser::open(const FileQuery& request) {
    if (process_) return false;
    try {
        if (find_program("zenity"))
            process_ = std::make_unique<ChildProcess>(zenity(request), false);
        else if (find_program("kdialog"))
            process_ = std::make_unique<ChildProcess>(kdialog(request), false);
    } catch (const OutputError&) {  // the window's own dialog will do
    }
    output_.clear();
    request_ = request;
    return process_ != nullptr;
}

std::optional<std::optional<fs::path>> NativeChooser::take_answer() {
    if (!process_) return std::nullopt;
    const std::optional<int> code = process_->exit_code();
    output_ += process_->output();
    if (!code) return std::nullopt;
    process_.reset();
    while (!output_.empty() && (output_.back() == '\n' || output_.back() == '\r')) output_.pop_back();
    if (*code != 0 || output_.empty()) return std::optional<fs::path>{};
    fs::path file = output_;
    if (request_.saving && !file.has_extension() && !request_.extensions.empty())
        file += request_.extensions[0];
    return std::optional<fs::path>(file);
}

}  // namespace astrosplat
