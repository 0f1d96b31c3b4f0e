// A lock beside each autosave is held by the process that writes it; the kernel gives it back when that
// process ends in any way. Process ids alone would lie: they are used again, and mean nothing on another
// machine that shares the folder.
#include "edit/autosave.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/file.h"
#include "core/hash.h"
#include "core/log.h"
#include "core/text.h"
#include "scene/save.h"

namespace astrosplat {
namespace fs = std::filesystem;
namespace {

constexpr const char* first_words = "# astrosplat autosave ";

fs::path lock_of(fs::path autosave) { return autosave.replace_extension(".lock"); }

std::string header_line(const Document& document) {
    const std::string time = fmt::format("{:%Y-%m-%d %H:%M:%S}", fmt::gmtime(std::time(nullptr)));
    const nlohmann::ordered_json facts{
        {"file", document.scene().file.string()}, {"titled", !document.file().empty()}, {"time", time}};
    return first_words + facts.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::optional<Recovery> read_header(const fs::path& autosave) {
    std::ifstream in(autosave, std::ios::binary);
    std::string line;
    if (!std::getline(in, line) || line.rfind(first_words, 0) != 0) return std::nullopt;
    try {
        const auto facts = nlohmann::json::parse(line.substr(std::string(first_words).size()));
        return Recovery{autosave, facts.at("file").get<std::string>(), facts.at("titled").get<bool>(),
                        facts.at("time").get<std::string>()};
    } catch (const nlohmann::json::exception&) {
        return std::nullopt;
    }
}

/// NAME-PID-HASH: two scenes of one name in one process differ by the hash of their place.
fs::path autosave_name(const Document& document) {
    const std::string name = document.file().empty() ? "Untitled" : document.file().stem().string();
    const std::string hash = Sha256().add(document.scene().file.string()).hex().substr(0, 8);
    return fmt::format("{}-{}-{}.toml", name.substr(0, 100), getpid(), hash);
}

/// For folders whose file system knows no locks: NAME-PID-HASH says who wrote it.
bool process_of_name_lives(const fs::path& autosave) {
    const std::string stem = autosave.stem().string();
    const std::size_t hash = stem.rfind('-');
    if (hash == std::string::npos || hash == 0) return false;
    const std::size_t pid = stem.rfind('-', hash - 1);
    if (pid == std::string::npos) return false;
    const std::optional<std::int64_t> number = parse_int64(stem.substr(pid + 1, hash - pid - 1));
    return number && *number > 0 && (kill(static_cast<pid_t>(*number), 0) == 0 || errno == EPERM);
}

/// Where a preset of the scene is gone, its values stand in the autosave itself.
std::string autosave_text(const Document& document, const fs::path& target) {
    try {
        return document.text_for(target);
    } catch (const InputError&) {
        Scene scene = document.scene();
        for (LayerParams& layer : scene.layers) layer.preset.clear();
        return save_text(scene, "", target);
    }
}

bool is_abandoned(const fs::path& autosave) {
    switch (FileLock(lock_of(autosave)).try_lock(FileLock::Missing::leave)) {
        case FileLock::State::held:
            return true;
        case FileLock::State::busy:
            return false;
        default:
            return !process_of_name_lives(autosave);
    }
}

}  // namespace

fs::path autosave_folder() {
    const fs::path state = state_folder();
    return state.empty() ? fs::path() : state / "autosave";
}

std::chrono::seconds autosave_interval(const Settings& settings) {
    const char* variable = std::getenv("ASTROSPLAT_AUTOSAVE_SECONDS");
    const std::optional<std::int64_t> seconds = variable ? parse_int64(variable) : std::nullopt;
    return seconds && *seconds >= 1 && *seconds <= 3600 ? std::chrono::seconds(*seconds)
                                                        : std::chrono::seconds(settings.autosave_s);
}

Autosave::Autosave(fs::path folder, Clock::duration every) : folder_(std::move(folder)), every_(every) {}

Autosave::~Autosave() {
    if (std::uncaught_exceptions() == 0) remove();
}

void Autosave::update(const Document& document, Clock::time_point now) {
    if (!document.edited()) {
        waiting_ = false;
        remove();
        return;
    }
    if (document.revision() == written_) return;
    if (!waiting_) changed_ = now;
    waiting_ = true;
    if (now - changed_ < every_) return;
    waiting_ = false;
    write(document);
}

bool Autosave::write(const Document& document) {
    if (folder_.empty()) return false;
    const fs::path target = folder_ / autosave_name(document);
    if (target != file_) remove();
    try {
        make_folder(folder_);
        if (!lock_) {
            lock_ = std::make_unique<FileLock>(lock_of(target));
            if (lock_->try_lock() != FileLock::State::held) lock_.reset();
        }
        write_file_atomically(target, header_line(document) + autosave_text(document, target));
    } catch (const std::exception& error) {
        log_warning(fmt::format("no autosave of {}: {}", document.name(), error.what()));
        return false;
    }
    file_ = target;
    written_ = document.revision();
    return true;
}

void Autosave::remove() {
    std::error_code ignored;
    if (!file_.empty()) fs::remove(file_, ignored);
    file_.clear();
    lock_.reset();
    written_ = 0;
}

std::string Recovery::name() const {
    return titled ? original.filename().string() : original.stem().string() + " (never saved)";
}

std::vector<Recovery> recoveries(const fs::path& folder) {
    std::vector<Recovery> found;
    for (const fs::path& file : entries_of(folder)) {
        if (file.extension() != ".toml" || file.filename().string().rfind(".", 0) == 0) continue;
        const std::optional<Recovery> recovery = read_header(file);
        if (recovery && is_abandoned(file)) found.push_back(*recovery);
    }
    std::sort(found.begin(), found.end(), [](const Recovery& a, const Recovery& b) {
        return a.time != b.time ? a.time > b.time : a.autosave < b.autosave;
    });
    return found;
}

Document recover(const fs::path& autosave) {
    const std::optional<Recovery> header = read_header(autosave);
    if (!header) bad_input(autosave.string(), "", "an autosave", "another file");
    const std::string text = read_file(autosave);
    return Document::recovered(text.substr(text.find('\n') + 1), autosave, header->original, header->titled);
}

void discard_recovery(const fs::path& autosave) {
    std::error_code ignored;
    fs::remove(autosave, ignored);
    fs::remove(lock_of(autosave), ignored);
}

}  // namespace astrosplat
