// The scene being edited: the scene itself, the text it came from, undo and redo, what is saved and what is
// not. In: a scene file, or the text of one that has no file yet; then edits. Out: a plain Scene after every
// edit. Knows no window. And files that other programs may write while they are in use here, its own and
// those that its scene reads: whether they were changed.
#pragma once

#include <map>

#include "core/file.h"
#include "scene/load.h"
#include "scene/parameter.h"
#include "scene/scene.h"

namespace astrosplat {

/// A file as it was last seen. Two calls of changed() cost two look-ups in its folder; its bytes are read
/// only when date or size say that it was touched.
class DiskFile {
  public:
    DiskFile() = default;
    /// `content` is what the file holds.
    DiskFile(const fs::path& file, std::string_view content);

    /// Its bytes differ from those last seen. A file that is gone or unreadable has not changed.
    bool changed();
    /// The file as it is now counts as seen.
    void accept();

  private:
    fs::path file_;      // empty: there is none
    FileStamp checked_;  // at the last look
    std::string hash_;
    bool changed_ = false;  // what that look found
};

class WatchedFiles {
  public:
    /// A second has passed since it was last due: it is time to look; `now` in seconds.
    bool due(double now);
    /// Watches these from now on; what is known of those watched already stays.
    void watch(const std::vector<fs::path>& files);
    /// Files whose date or size differ from those when they were first watched or last returned, or that have
    /// appeared, and that lie there as they did at the call before. A file that is gone is waited for: many
    /// programs write a file by replacing it.
    std::vector<fs::path> changed();
    /// Differs whenever changed() gave some: what is kept of them is to be read again.
    std::uint64_t changes() const { return changes_; }

  private:
    struct Entry {
        FileStamp known, seen;  // as returned last; at the last call
    };

    std::map<fs::path, Entry> files_;
    double checked_at_s_ = 0.0;
    std::uint64_t changes_ = 0;
};

/// Edits that belong together (one drag of a slider) carry the same id and make one undo step; 0: a step of
/// its own.
using Gesture = std::uint64_t;

class Document {
  public:
    /// Opens a scene file. Throws InputError. What `assignments` (--set) change is an edit like any other:
    /// the document begins as edited(), and saving writes it. Their keys are remembered (set_by_command_line)
    /// until they are saved.
    static Document open(const fs::path& file, std::span<const Assignment> assignments = {});
    /// A scene without a file: `toml` as if it were at `place`, whose folder resolves its paths. Saving asks
    /// for a file; until the first edit there is nothing to save. Throws InputError.
    static Document untitled(const std::string& toml, const fs::path& place,
                             std::span<const Assignment> assignments = {});
    /// The content of an autosave, `toml` at `place`, as edits of `file`: edited(), and save() writes there.
    /// Not `titled`: an untitled scene that was at `file`. Throws InputError.
    static Document recovered(const std::string& toml, const fs::path& place, const fs::path& file,
                              bool titled);

    Document(Document&&) noexcept;
    Document& operator=(Document&&) noexcept;
    ~Document();

    const Scene& scene() const;
    /// Differs after every edit, undo, redo and load.
    std::uint64_t revision() const;
    /// Empty when untitled.
    const fs::path& file() const;
    std::string name() const;  // "whirlpool.toml", "Untitled"
    bool edited() const;       // differs from what lies on disk; untitled: from what it began as
    /// The text on disk (untitled: the one it began with), as far as this document knows.
    const Scene& saved_scene() const;
    /// The text that it began with, or began again with, where that is the scene that is edited; else null.
    std::shared_ptr<const std::string> began() const;
    /// Begins again with another text, as if it were at `place`, as one undo step called `name`; an untitled
    /// one is then not edited.
    /// Throws InputError; the scene is then as before.
    void begin_again(const std::string& name, const std::string& toml, const fs::path& place,
                     std::span<const Assignment> assignments = {});

    /// Applies `change` to a copy and makes it the scene as one undo step called `name` ("Opacity of dust").
    /// Throws what `change` throws, and InputError where the result breaks a rule between parameters; the
    /// scene is then as before. An edit that changes nothing is not recorded. Tracks of what the edit removed
    /// go with it. The last 500 steps can be undone.
    void edit(const std::string& name, const std::function<void(Scene&)>& change, Gesture gesture = 0);

    /// Sets one parameter by its full key. An animated parameter gets (or changes) the keyframe at `frame`,
    /// any other its value. A file's path may be relative to the scene's folder; the list a key names grows
    /// by one element where that is missing. Throws InputError as edit() does.
    void set(const std::string& key, const Value& value, double frame, Gesture gesture = 0);
    /// Back to the default, animation of it removed.
    void reset(const std::string& key);
    /// The parameter's default in a new scene.
    static Value default_value(const ParameterSpec& spec);
    /// `--set` gave this key the value it still has, and it was not saved.
    bool set_by_command_line(const std::string& key) const;

    bool can_undo() const;
    bool can_redo() const;
    std::string undo_name() const;  // empty when there is nothing to undo
    std::string redo_name() const;
    void undo();
    void redo();

    /// Names of the steps, oldest first; the first is the document as it was opened. The scene is as after
    /// the step of number history_place().
    std::vector<std::string> history() const;
    std::size_t history_place() const;
    /// Undoes or redoes to a step of history().
    void go_to(std::size_t step);

    /// Writes the scene's file, atomically, keeping comments and order. Throws OutputError, and InputError
    /// when untitled or a preset the scene uses cannot be read any more.
    void save();
    /// Writes to `file`, which the document then is; frames go on going where they went. Throws as save()
    /// does; the document is then as before.
    void save_as(const fs::path& file);
    /// The text that save_as(file) would write.
    std::string text_for(const fs::path& file) const;

    /// The file was changed by another program since it was read or saved (asked of the disk now).
    bool changed_on_disk() const;
    /// Reads the file again as one undo step; `--set` that was not saved wins over it again. Throws
    /// InputError; the scene is then as before.
    void reload();
    /// Keeps what is here; changed_on_disk() is false until the next change.
    void ignore_change_on_disk();

  private:
    struct State;
    explicit Document(std::unique_ptr<State> state);
    /// Checks `edited` and makes it the scene.
    void take(Scene edited, const std::string& edit_name, Gesture gesture);
    std::unique_ptr<State> state_;
};

}  // namespace astrosplat
