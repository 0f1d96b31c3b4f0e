// A lock beside each autosave is held by the process that writes it; the kernel gives it back when that
// process ends in any way. Process ids alone would lie: they are used again, and mean nothing on another
// machine that shares the folder. A look's layers are matched by name, its tracks by their key.
#include "edit/kept_files.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/file.h"
#include "core/hash.h"
#include "core/log.h"
#include "core/text.h"
#include "edit/edits.h"
#include "edit/layers.h"
#include "scene/load.h"
#include "scene/save.h"

namespace astrosplat {
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

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SnapshotFacts, name, frame, splats, seconds)

namespace {

/// Whether a key is part of the look of a layer that both scenes have.
bool is_of_look(const ParameterKey& key, const Scene& scene, const Scene& stored) {
    if (key == "output.exposure") return true;
    const std::string name = key.layer();
    const ParameterKey layer = layer_key(name);
    const bool look =
        key.is_below(layer / "look") || key.is_below(layer / "render") || key == layer / "visible";
    return look && find_layer(scene, name) && find_layer(stored, name);
}

}  // namespace

StoredLook store_look(const SnapshotFacts& facts, const Document& document) {
    return {facts, std::make_shared<const Scene>(document.scene())};
}

Scene with_look_of(const Scene& scene, const Scene& stored) {
    Scene result = scene;
    result.output.exposure = stored.output.exposure;
    for (LayerParams& layer : result.layers) {
        const LayerParams* old = find_layer(stored, layer.name);
        if (!old) continue;
        layer.look = old->look;
        layer.render = old->render;
        layer.visible = old->visible;
    }
    // A track that both have keeps its place in the list, so that going back and forth changes nothing else.
    result.animation.clear();
    for (const Track& track : scene.animation) {
        const Track* const old = find_track(stored, track.key);
        if (!is_of_look(track.key, scene, stored))
            result.animation.push_back(track);
        else if (old)
            result.animation.push_back(*old);
    }
    for (const Track& track : stored.animation)
        if (is_of_look(track.key, scene, stored) && !find_track(scene, track.key))
            result.animation.push_back(track);
    return result;
}

void restore_look(Document& document, const StoredLook& stored) {
    document.edit("Restore " + stored.name,
                  [&](Scene& scene) { scene = with_look_of(scene, *stored.scene); });
}

namespace {

constexpr std::string_view head_of_facts = "# astrosplat snapshot ";

std::string facts_line(const SnapshotFacts& facts) {
    return std::string(head_of_facts) +
           nlohmann::json(facts).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

/// Throws InputError where the text begins with something else.
SnapshotFacts facts_of(const std::string& text, const fs::path& file) {
    const std::string_view line = std::string_view(text).substr(0, text.find('\n'));
    try {
        if (line.starts_with(head_of_facts)) return nlohmann::json::parse(line.substr(head_of_facts.size()));
    } catch (const nlohmann::json::exception&) {
        // The line below says it.
    }
    bad_input(file.string(), "1", "a snapshot", "another file");
}

StoredLook read_snapshot(const fs::path& file) {
    const std::string text = read_file(file);
    return {facts_of(text, file), std::make_shared<const Scene>(parse_scene(text, file)), file};
}

/// Of "0012.toml" 12; 0 for other names.
std::int64_t number_of_file(const fs::path& file) {
    if (file.extension() != ".toml") return 0;
    return parse_int64(file.stem().string()).value_or(0);
}

std::vector<fs::path> numbered_files(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const fs::path& entry : entries_of(folder))
        if (number_of_file(entry) > 0) files.push_back(entry);
    std::ranges::sort(files, {}, number_of_file);
    return files;
}

}  // namespace

fs::path snapshot_folder(const fs::path& scene_file) {
    return fs::path(scene_file).replace_extension(".snapshots");
}

fs::path snapshot_image(const fs::path& snapshot) { return fs::path(snapshot).replace_extension(".png"); }

std::vector<StoredLook> read_snapshots(const fs::path& folder, std::vector<std::string>& problems) {
    std::vector<StoredLook> found;
    for (const fs::path& file : numbered_files(folder)) {
        try {
            found.push_back(read_snapshot(file));
        } catch (const InputError& error) {
            problems.push_back(error.what());
        }
    }
    return found;
}

fs::path write_snapshot(const fs::path& folder, const SnapshotFacts& facts, const Scene& scene,
                        const std::string& png) {
    make_folder(folder);
    const std::vector<fs::path> files = numbered_files(folder);
    Scene whole = scene;
    for (LayerParams& layer : whole.layers) layer.preset.clear();
    for (std::int64_t number = files.empty() ? 1 : number_of_file(files.back()) + 1;; ++number) {
        const fs::path file = folder / fmt::format("{:04}.toml", number);
        try {
            write_file_atomically(file, facts_line(facts) + save_text(whole, "", file), Existing::keep);
        } catch (const AlreadyExists&) {
            continue;  // another window took the number
        }
        write_file_atomically(snapshot_image(file), png);
        return file;
    }
}

void rename_snapshot(const fs::path& snapshot, const std::string& name) {
    const std::string text = read_file(snapshot);
    SnapshotFacts facts = facts_of(text, snapshot);
    facts.name = name;
    write_file_atomically(snapshot,
                          facts_line(facts) + text.substr(std::min(text.find('\n'), text.size() - 1) + 1));
}

void remove_snapshot(const fs::path& snapshot) {
    for (const fs::path& file : {snapshot, snapshot_image(snapshot)}) {
        std::error_code error;
        fs::remove(file, error);
        if (error)
            throw OutputError(fmt::format("{}: cannot be removed: {}", file.string(), error.message()));
    }
}

}  // namespace astrosplat
