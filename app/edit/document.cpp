// The history is a row of whole scenes: undo and redo walk along it, nothing is ever computed backwards. Of
// files date and size are looked at first, then the bytes.
#include "edit/document.h"

#include <atomic>
#include <deque>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/hash.h"
#include "edit/edits.h"
#include "edit/layers.h"
#include "scene/camera_file.h"
#include "scene/describe.h"
#include "scene/entries.h"
#include "scene/parameter_key.h"
#include "scene/save.h"

namespace astrosplat {

DiskFile::DiskFile(const fs::path& file, std::string_view content)
    : file_(file), checked_(stamp_of(file)), hash_(Sha256().add(content).hex()) {}

bool DiskFile::changed() {
    if (file_.empty()) return false;
    const FileStamp now = stamp_of(file_);
    if (now == FileStamp{}) return false;
    if (now == checked_) return changed_;
    try {
        changed_ = sha256_of_file(file_) != hash_;
    } catch (const InputError&) {
        return false;
    }
    checked_ = now;
    return changed_;
}

void DiskFile::accept() {
    if (file_.empty()) return;
    try {
        checked_ = stamp_of(file_);
        hash_ = sha256_of_file(file_);
        changed_ = false;
    } catch (const InputError&) {
        // gone: nothing to accept
    }
}

bool WatchedFiles::due(double now) {
    constexpr double every_s = 1.0;
    if (now - checked_at_s_ < every_s) return false;
    checked_at_s_ = now;
    return true;
}

void WatchedFiles::watch(const std::vector<fs::path>& files) {
    std::map<fs::path, Entry> watched;
    for (const fs::path& file : files) {
        const auto known = files_.find(file);
        if (known != files_.end()) {
            watched.insert(*known);
        } else if (!watched.count(file)) {
            const FileStamp now = stamp_of(file);
            watched[file] = {now, now};
        }
    }
    files_ = std::move(watched);
}

std::vector<fs::path> WatchedFiles::changed() {
    std::vector<fs::path> found;
    for (auto& [file, entry] : files_) {
        const FileStamp now = stamp_of(file), before = std::exchange(entry.seen, now);
        if (now == FileStamp{} || now == entry.known || now != before) continue;
        entry.known = now;
        found.push_back(file);
    }
    if (!found.empty()) ++changes_;
    return found;
}

namespace {

constexpr std::size_t most_undo_steps = 500;

/// One scene of the history and the edit that made it of the one before.
struct Step {
    std::shared_ptr<const Scene> scene;
    std::string name;
    Gesture gesture = 0;
    /// The file's content as it was read or written with this very scene; null: it never was. Saving again
    /// what was undone to leaves no trace of what lay there meanwhile.
    std::shared_ptr<const std::string> text = nullptr;
    /// The text that an untitled document begins with here; null: it goes on.
    std::shared_ptr<const std::string> began = nullptr;
};

/// Grows through all documents, so that a revision never means two scenes.
std::uint64_t next_revision() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}

bool covers(const ParameterKey& assigned, const ParameterKey& key) {
    return key == assigned || key.is_below(assigned);
}

/// "Opacity of dust"; parameters of no layer have their label alone.
std::string edit_name(const ParameterSpec& spec) {
    const std::string layer = spec.key.layer();
    return layer.empty() ? spec.label : spec.label + " of " + layer;
}

/// The layer that a key such as "layer.stars.name" is of.
std::size_t layer_index(const Scene& scene, const ParameterKey& key) {
    return static_cast<std::size_t>(find_layer(scene, key.layer()) - scene.layers.data());
}

/// The parameter of a key in `scene`, whose lists grow for it.
Parameter parameter_for(Scene& scene, const ParameterKey& key) {
    Description description = describe(scene);
    if (const Parameter* parameter = find_parameter(description, key)) return *parameter;
    naming(key, [&] {
        while (extend_lists(description, key)) description = describe(scene);
    });
    if (const Parameter* parameter = find_parameter(description, key)) return *parameter;
    throw InputError(why_unknown(scene, key));
}

void set_value(const Parameter& parameter, const Value& value, const fs::path& folder) {
    naming(parameter.spec.key, [&] { parameter.set(resolve_paths(value, parameter.spec, folder, false)); });
}

/// A preset that cannot be read would be met only at saving.
void check_new_presets(const Scene& before, const Scene& after) {
    for (const LayerParams& layer : after.layers) {
        const bool known = std::any_of(before.layers.begin(), before.layers.end(),
                                       [&](const LayerParams& old) { return old.preset == layer.preset; });
        LayerParams scratch;
        if (!known && !layer.preset.empty()) apply_preset(scratch, layer.preset);
    }
}

}  // namespace

struct Document::State {
    fs::path file;        // empty: untitled
    fs::path text_place;  // where `text` resolves its paths
    std::string text;     // what saving edits
    std::shared_ptr<const Scene> saved;
    DiskFile disk;
    std::vector<Assignment> assignments;
    std::vector<ParameterKey> assigned_keys;  // full
    Scene assigned;                           // what the assignments made

    std::deque<Step> history;
    std::size_t now = 0;  // index into history
    std::uint64_t revision = next_revision();

    const Scene& scene() const { return *history[now].scene; }

    void begin(Scene scene) {
        history = {{std::make_shared<const Scene>(std::move(scene)), "", 0}};
        now = 0;
    }

    /// The step that the scene goes on from, of an untitled document; null: none is known any more.
    const Step* beginning() const {
        if (!file.empty()) return nullptr;
        for (std::size_t i = now + 1; i-- > 0;)
            if (history[i].began) return &history[i];
        return nullptr;
    }
    const std::shared_ptr<const Scene>& unedited() const {
        const Step* const step = beginning();
        return step ? step->scene : saved;
    }

    /// `content` is what lies in the document's file. Throws InputError, and nothing has changed.
    void know_disk(const std::string& content) {
        Scene read = parse_unchecked(content, file);
        try {
            attach_camera_file(read, file.string());
        } catch (const InputError&) {
            // The file there cannot be rendered; it can be saved over.
        }
        saved = std::make_shared<const Scene>(std::move(read));
        text = content;
        text_place = file;
        disk = DiskFile(file, content);
    }

    void remember_assignments(std::span<const Assignment> given) {
        assignments.assign(given.begin(), given.end());
        assigned_keys.clear();
        assigned = scene();
        const Description description = describe(assigned);
        for (const Assignment& assignment : assignments) {
            const ParameterKey& key = assignment.key;
            const bool track = key.is_below("animation");
            assigned_keys.push_back(full_key(description, track ? key.moved("animation", {}) : key));
        }
    }

    void know_text(const std::string& content) {
        history[now].text = std::make_shared<const std::string>(content);
    }

    /// Of `shown` in the file `target`, with the comments and the order of what was read.
    std::string text_of(Scene shown, const fs::path& target) const {
        shown.file = text_place;
        const Step* const step = beginning();
        return save_text(shown, step ? *step->began : text, target);
    }

    void forget_assignments() {
        assignments.clear();
        assigned_keys.clear();
    }

    /// A new step after the current one; what could be redone is gone.
    void record(Step step) {
        history.erase(history.begin() + static_cast<std::ptrdiff_t>(now) + 1, history.end());
        const bool merges = step.gesture != 0 && now > 0 && history[now].gesture == step.gesture;
        if (merges) {
            history[now].scene = step.scene;
            history[now].text.reset();
        } else {
            history.push_back(std::move(step));
        }
        if (merges && *history[now].scene == *history[now - 1].scene) history.pop_back();  // dragged back
        if (history.size() > most_undo_steps + 1) {
            if (file.empty() && history[0].began) {  // its text and its scene are known beyond it
                text = *history[0].began;
                saved = history[0].scene;
            }
            history.pop_front();
        }
        now = history.size() - 1;
        revision = next_revision();
    }

    /// The document is now `new_file`: so is every scene that undo can bring back.
    void move_to(const fs::path& new_file) {
        if (file == new_file) return;
        file = new_file;
        for (Step& step : history) {
            Scene moved = *step.scene;
            moved.file = new_file;
            step.scene = std::make_shared<const Scene>(std::move(moved));
            step.text.reset();  // paths in it were relative to another folder
        }
        revision = next_revision();
    }
};

Document::Document(std::unique_ptr<State> state) : state_(std::move(state)) {}
Document::Document(Document&&) noexcept = default;
Document& Document::operator=(Document&&) noexcept = default;
Document::~Document() = default;

Document Document::open(const fs::path& file, std::span<const Assignment> assignments) {
    auto state = std::make_unique<State>();
    state->file = fs::absolute(file);
    const std::string text = read_file(file);
    state->begin(parse_scene(text, state->file, assignments));
    state->remember_assignments(assignments);
    state->know_disk(text);
    if (assignments.empty()) state->know_text(text);
    return Document(std::move(state));
}

Document Document::untitled(const std::string& toml, const fs::path& place,
                            std::span<const Assignment> assignments) {
    auto state = std::make_unique<State>();
    state->text_place = fs::absolute(place);
    state->text = toml;
    state->begin(parse_scene(toml, state->text_place, assignments));
    state->history[0].began = std::make_shared<const std::string>(toml);
    state->remember_assignments(assignments);
    state->saved = state->history[0].scene;
    return Document(std::move(state));
}

Document Document::recovered(const std::string& toml, const fs::path& place, const fs::path& file,
                             bool titled) {
    auto state = std::make_unique<State>();
    Scene scene = parse_scene(toml, fs::absolute(place));
    scene.file = file;
    state->begin(std::move(scene));
    state->saved = std::make_shared<const Scene>();
    state->text = toml;
    state->text_place = fs::absolute(place);
    if (titled) state->file = file;
    std::error_code ignored;
    if (titled && fs::exists(file, ignored)) {
        try {
            state->know_disk(read_file(file));  // what is there keeps its comments and order
        } catch (const InputError&) {
            // It cannot be read: saving will replace it by what was recovered.
        }
    }
    return Document(std::move(state));
}

const Scene& Document::scene() const { return state_->scene(); }
std::uint64_t Document::revision() const { return state_->revision; }
const fs::path& Document::file() const { return state_->file; }
std::string Document::name() const {
    return state_->file.empty() ? "Untitled" : state_->file.filename().string();
}
const Scene& Document::saved_scene() const { return *state_->unedited(); }
bool Document::edited() const {
    const std::shared_ptr<const Scene>& unedited = state_->unedited();
    return state_->history[state_->now].scene != unedited && !(scene() == *unedited);
}

std::shared_ptr<const std::string> Document::began() const {
    const Step* const step = state_->beginning();
    return step ? step->began : nullptr;
}

void Document::begin_again(const std::string& name, const std::string& toml, const fs::path& place,
                           std::span<const Assignment> assignments) {
    Scene scene = parse_scene(toml, fs::absolute(place), assignments);
    scene.file = this->scene().file;
    state_->record({std::make_shared<const Scene>(std::move(scene)), name, 0, nullptr,
                    std::make_shared<const std::string>(toml)});
    state_->remember_assignments(assignments);
}

void Document::edit(const std::string& name, const std::function<void(Scene&)>& change, Gesture gesture) {
    Scene edited = scene();
    change(edited);
    take(std::move(edited), name, gesture);
}

void Document::take(Scene edited, const std::string& edit_name, Gesture gesture) {
    edited.file = scene().file;
    if (edited == scene()) return;
    if (edited.output.preset != scene().output.preset)
        apply_output_preset(edited);
    else
        keep_dome_square(edited, scene());
    check_edited_scene(edited, name());
    check_new_presets(scene(), edited);
    if (edited == scene()) return;  // its tracks were of nothing
    film_still(scene(), edited);
    state_->record({std::make_shared<const Scene>(std::move(edited)), edit_name, gesture});
}

void Document::set(const std::string& key, const Value& value, double frame, Gesture gesture) {
    Scene edited = scene();
    const Parameter parameter = parameter_for(edited, key);
    const ParameterSpec& spec = parameter.spec;
    if (spec.generic_key == "layer.name" && value.text())
        rename_layer(edited, layer_index(edited, spec.key), *value.text());
    else if (is_animated(edited, spec.key))
        set_keyframe(edited, spec.key, frame, value);
    else
        set_value(parameter, value, edited.file.parent_path());
    take(std::move(edited), edit_name(spec), gesture);
}

void Document::reset(const std::string& key) {
    Scene edited = scene();
    const Parameter parameter = parameter_for(edited, key);
    remove_track(edited, parameter.spec.key);
    parameter.set(default_value(parameter.spec));
    take(std::move(edited), "Reset " + edit_name(parameter.spec), 0);
}

Value Document::default_value(const ParameterSpec& spec) {
    const auto& rows = parameter_rows();
    const auto row = std::find_if(rows.begin(), rows.end(),
                                  [&](const ParameterRow& r) { return r.spec.key == spec.generic_key; });
    return row == rows.end() ? Value() : row->value;
}

bool Document::set_by_command_line(const std::string& key) const {
    const auto& keys = state_->assigned_keys;
    if (!std::any_of(keys.begin(), keys.end(), [&](const ParameterKey& k) { return covers(k, key); }))
        return false;
    Scene then = state_->assigned, current = scene();
    const Description description_then = describe(then), description_now = describe(current);
    const Parameter* before = find_parameter(description_then, key);
    const Parameter* after = find_parameter(description_now, key);
    if (!before || !after || !(before->get() == after->get())) return false;
    const Track* track_then = find_track(then, key);
    const Track* track_now = find_track(current, key);
    return track_then && track_now ? *track_then == *track_now : track_then == track_now;
}

bool Document::can_undo() const { return state_->now > 0; }
bool Document::can_redo() const { return state_->now + 1 < state_->history.size(); }
std::string Document::undo_name() const { return can_undo() ? state_->history[state_->now].name : ""; }
std::string Document::redo_name() const { return can_redo() ? state_->history[state_->now + 1].name : ""; }

void Document::undo() {
    if (can_undo()) go_to(state_->now - 1);
}

void Document::redo() {
    if (can_redo()) go_to(state_->now + 1);
}

std::vector<std::string> Document::history() const {
    std::vector<std::string> names;
    for (const auto& step : state_->history) names.push_back(step.name);
    return names;
}

std::size_t Document::history_place() const { return state_->now; }

void Document::go_to(std::size_t step) {
    assert(step < state_->history.size());
    state_->now = step;
    state_->revision = next_revision();
}

namespace {

// The pattern of frames, as a scene in another folder says where they go now. A scene without a file says
// nothing yet.
std::string pattern_from(const std::string& pattern, const fs::path& file, const fs::path& target) {
    if (file.empty() || fs::path(pattern).is_absolute()) return pattern;
    const fs::path from = fs::absolute(file).parent_path(), to = target.parent_path();
    if (from == to) return pattern;
    const fs::path moved = (from / pattern).lexically_normal().lexically_relative(to.lexically_normal());
    return moved.empty() ? (from / pattern).lexically_normal().string() : moved.string();
}

}  // namespace

std::string Document::text_for(const fs::path& file) const {
    const Step& step = state_->history[state_->now];
    if (step.text && fs::absolute(file) == state_->file) return *step.text;
    return state_->text_of(scene(), fs::absolute(file));
}

void Document::save() {
    if (state_->file.empty()) throw InputError("Untitled: expected a file to save to, found none");
    save_as(state_->file);
}

void Document::save_as(const fs::path& file) {
    const fs::path target = fs::absolute(file);
    Scene moved = scene();
    moved.output.path = pattern_from(moved.output.path, state_->file, target);
    const bool same = moved == scene();
    const std::string text = same ? text_for(target) : state_->text_of(moved, target);
    write_file_atomically(target, text);
    if (!same) state_->record({std::make_shared<const Scene>(std::move(moved)), "Keep where frames go"});
    state_->text = text;
    state_->text_place = target;
    state_->move_to(target);
    state_->know_text(text);
    state_->saved = state_->history[state_->now].scene;
    state_->disk = DiskFile(target, text);
    state_->forget_assignments();
}

bool Document::changed_on_disk() const { return state_->disk.changed(); }

void Document::reload() {
    if (state_->file.empty()) throw InputError("Untitled: expected a file to read again, found none");
    const std::string text = read_file(state_->file);
    const Scene scene = parse_scene(text, state_->file, state_->assignments);
    state_->know_disk(text);
    edit("Reload", [&](Scene& edited) { edited = scene; });
    for (Step& step : state_->history) step.text.reset();  // what other hands wrote since is kept
    if (state_->assignments.empty()) state_->know_text(text);
}

void Document::ignore_change_on_disk() { state_->disk.accept(); }

}  // namespace astrosplat
