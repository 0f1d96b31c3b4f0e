// Tables of keyframes (.csv): a header that names `frame` and keys, and a row for every frame.
#include "scene/camera_file.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/file.h"
#include "core/text.h"
#include "scene/describe.h"
#include "scene/entries.h"
#include "scene/load.h"
#include "scene/parameter.h"

namespace astrosplat {
namespace {

constexpr std::array<std::string_view, 2> component_names{"xyzw", "rgb"};

/// The columns of one key.
struct KeyColumns {
    Track track;
    std::vector<std::optional<std::size_t>> columns;  // by component
};

/// A column's name as a key, and which of its numbers it is; -1: all of it.
struct ColumnName {
    ParameterKey key;
    int component = -1;
};

/// Vectors have a column for each of their numbers, all other parameters one.
bool has_components(const ParameterSpec& spec) { return spec.components > 1; }

ColumnName column_name(const Description& description, std::string_view word) {
    if (find_parameter(description, word) || word.size() < 3 || word[word.size() - 2] != '.') return {word};
    const std::string_view rest = word.substr(0, word.size() - 2);
    const Parameter* vector = find_parameter(description, rest);
    if (!vector || !has_components(vector->spec)) return {word};
    for (const std::string_view names : component_names)
        if (const std::size_t at = names.find(word.back()); at < names.size()) return {rest, int(at)};
    return {word};
}

class CsvReader {
  public:
    CsvReader(const fs::path& file, std::string_view text, const FrameRate& rate, Scene& scene)
        : place_(file.string()), rows_(text, place_), rate_(rate), scene_(scene) {}

    std::vector<Track> read() {
        read_header();
        Scene scratch = scene_;  // values are checked by setting them
        const Description description = describe(scratch);
        for (KeyColumns& key : keys_) parameters_.push_back(find_parameter(description, key.track.key));
        while (rows_.next()) read_row();
        std::vector<Track> tracks;
        for (KeyColumns& key : keys_) {
            if (key.track.keyframes.empty()) rows_.fail("rows of numbers below the header", "none");
            tracks.push_back(std::move(key.track));
        }
        return tracks;
    }

  private:
    void read_header() {
        if (!rows_.next()) rows_.fail("a header such as frame,camera.position.x", "an empty file");
        separator_ = separator_of(rows_.text());
        const std::vector<std::string_view> names = rows_.fields(separator_);
        const auto frame = std::ranges::find(names, "frame");
        if (frame == names.end())
            rows_.fail("a header with a column 'frame'", shown(names.empty() ? "" : names[0]));
        frame_ = std::size_t(frame - names.begin());
        columns_ = names.size();
        grow_lists(names);
        const Description description = describe(scene_);
        for (std::size_t i = 0; i < names.size(); ++i)
            if (i != frame_) add_column(description, names[i], i);
        if (keys_.empty()) rows_.fail("at least one key besides 'frame'", "none");
        for (const KeyColumns& key : keys_) check_complete(key);
    }

    void grow_lists(const std::vector<std::string_view>& names) {
        for (const std::string_view name : names) {
            try {
                extend_lists(describe(scene_), name);
            } catch (const ValueError& error) {
                throw InputError(fmt::format("{}:{}: {}: {}", place_, rows_.line(), name, error.what()));
            }
        }
    }

    void add_column(const Description& description, std::string_view name, std::size_t column) {
        const ColumnName of = column_name(description, name);
        const Parameter* parameter = find_parameter(description, of.key);
        if (!parameter)
            throw InputError(
                fmt::format("{}:{}: {}", place_, rows_.line(), why_unknown(scene_, printable(name))));
        const ParameterSpec& spec = parameter->spec;
        if (spec.animation == Animation::no) rows_.fail("keys that can be animated", shown(name));
        if (spec.type == ParameterType::curve) rows_.fail("keys of numbers", shown(name) + ", a curve");
        const auto count = std::size_t(spec.components);
        const auto component = std::size_t(std::max(of.component, 0));
        if (of.component < 0 && has_components(spec))
            rows_.fail(fmt::format("columns {0}.x, {0}.y, ...", spec.key), shown(name));
        if (component >= count) rows_.fail(fmt::format("{} numbers for {}", count, spec.key), shown(name));
        auto key = std::ranges::find_if(keys_, [&](const KeyColumns& k) { return k.track.key == spec.key; });
        if (key == keys_.end()) {
            keys_.push_back({{}, std::vector<std::optional<std::size_t>>(count)});
            key = keys_.end() - 1;
            key->track.key = spec.key;
        }
        if (key->columns[component]) rows_.fail("each column once", shown(name) + " twice");
        key->columns[component] = column;
    }

    void check_complete(const KeyColumns& key) const {
        for (std::size_t i = 0; i < key.columns.size(); ++i)
            if (!key.columns[i])
                rows_.fail(fmt::format("{} columns for {}", key.columns.size(), key.track.key),
                           fmt::format("none for its number {}", i + 1));
    }

    void read_row() {
        const std::vector<std::string_view>& words = rows_.fields(separator_);
        if (words.size() != columns_)
            rows_.fail(fmt::format("{} columns as in the header", columns_), std::to_string(words.size()));
        const double frame = rows_.number(words[frame_], "the frame") * rate_.output_frames();
        if (!std::isfinite(frame)) rows_.fail("a frame number", shown(words[frame_]));
        for (std::size_t k = 0; k < keys_.size(); ++k) {
            KeyColumns& key = keys_[k];
            auto& keyframes = key.track.keyframes;
            if (!keyframes.empty() && !(frame > keyframes.back().frame))
                rows_.fail("ascending frames, each once",
                           fmt::format("{} after {}", shortest(frame), shortest(keyframes.back().frame)));
            keyframes.push_back(
                {frame, numbers_of_row(words, key, *parameters_[k]), Interpolation::linear, {}, {}});
        }
    }

    std::vector<double> numbers_of_row(const std::vector<std::string_view>& words, const KeyColumns& key,
                                       const Parameter& parameter) const {
        try {
            if (!has_components(parameter.spec)) {
                const std::string_view word = words[*key.columns[0]];
                return keyframe_numbers(parameter, is_numeric(parameter.spec.type)
                                                       ? Value(rows_.number(word, key.track.key.text()))
                                                       : typed_value(std::string(word)));
            }
            Value::List list;
            for (const std::optional<std::size_t>& column : key.columns)
                list.emplace_back(rows_.number(words[*column], key.track.key.text()));
            return keyframe_numbers(parameter, list);
        } catch (const ValueError& error) {
            throw InputError(fmt::format("{}:{}: {}: {}", place_, rows_.line(), key.track.key, error.what()));
        }
    }

    std::string place_;
    TextRows rows_;
    FrameRate rate_;
    Scene& scene_;
    char separator_ = ',';
    std::size_t frame_ = 0, columns_ = 0;
    std::vector<KeyColumns> keys_;
    std::vector<const Parameter*> parameters_;
};

}  // namespace

std::vector<Track> read_csv_tracks(const fs::path& file, const FrameRate& rate, Scene& scene) {
    const std::string text = read_file(file);
    return CsvReader(file, text, rate, scene).read();
}

std::string csv_text(const std::vector<Track>& tracks) {
    std::string text = "frame";
    for (const Track& track : tracks) {
        const std::size_t count = track.keyframes.front().value.size();
        for (std::size_t c = 0; c < count; ++c)
            text +=
                count == 1 ? "," + track.key.text() : fmt::format(",{}.{}", track.key, component_names[0][c]);
    }
    text += "\n";
    for (std::size_t i = 0; i < tracks.front().keyframes.size(); ++i) {
        text += shortest(tracks.front().keyframes[i].frame);
        for (const Track& track : tracks)
            for (const double number : track.keyframes[i].value) text += "," + shortest(number);
        text += "\n";
    }
    return text;
}

}  // namespace astrosplat
