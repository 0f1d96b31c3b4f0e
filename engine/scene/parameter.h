// One parameter of a scene. Its value as a scene file writes it: what TOML can say, without the tables. Facts
// about it: its key, its words for people, its range, whether it may be animated; and a handle that reads and
// writes it in the struct it lives in. describe.h makes these; load, save, --set, animation and the window
// only read them, and speak only Values.
#pragma once

#include <variant>

#include "core/error.h"
#include "core/text.h"
#include "scene/parameter_key.h"

namespace astrosplat {

struct Value {
    using List = std::vector<Value>;
    std::variant<bool, std::int64_t, double, std::string, List> data;

    Value() : data(List{}) {}
    Value(bool b) : data(b) {}
    Value(std::int64_t i) : data(i) {}
    Value(double d) : data(d) {}
    Value(const char* text) : data(std::string(text)) {}
    Value(std::string text) : data(std::move(text)) {}
    Value(List list) : data(std::move(list)) {}

    const std::string* text() const { return std::get_if<std::string>(&data); }
    const List* list() const { return std::get_if<List>(&data); }
    bool is_number() const { return data.index() == 1 || data.index() == 2; }
    double number() const;  // of an integer or a number
};
bool operator==(const Value& a, const Value& b);

/// TOML text: numbers shortest round-trip and with a point, strings quoted and escaped, lists in brackets.
std::string to_toml(const Value& value);
std::string to_toml(const std::string& text);

/// A value as written, for messages: "a number", "the text 'abc'", "a list of 2".
std::string kind_of(const Value& value);

/// Shortest text that reads back as `number`; "12" for whole numbers.
std::string short_number(double number);

/// A float as the double with the same shortest decimal text: 0.35f becomes 0.35, not 0.3499999940395355.
double widen(float number);

enum class ParameterType {
    boolean,
    integer,
    number,
    text,
    choice,    // one of ParameterSpec::choices
    words,     // a list of choices
    file,      // a path; `choices` are names that stand for themselves ("plane")
    files,     // "" or one path or a list of paths
    pattern,   // path of the frame files
    vector,    // `components` numbers
    position,  // a vector that moves along a curve when animated
    color,     // linear r, g, b
    rotation,  // quaternion x, y, z, w
    curve      // [[x, y], ...] with x ascending, or in any order
};

constexpr auto names_of(ParameterType) {
    return names_up_to<ParameterType::curve>("boolean", "integer", "number", "text", "choice", "words",
                                             "file", "files", "pattern", "vector", "position", "color",
                                             "rotation", "curve");
}

/// Whether its values are numbers, which have a range.
bool is_numeric(ParameterType type);

enum class Scale { linear, logarithmic };

/// Whether a parameter may be a key of [animation], and how its values follow each other.
enum class Animation { no, steps, yes };
constexpr auto names_of(Animation) { return names_up_to<Animation::yes>("no", "steps", "yes"); }

/// No number of a scene is farther from 0 than this, unless its own range is narrower: squares and products
/// of a few of them stay finite in 32 bits.
inline constexpr double largest_number = 1e12;

/// Another parameter on whose value it depends whether this one does anything.
struct Condition {
    ParameterKey key;
    std::vector<Value> values;
    bool wanted = true;  // false: it must have none of the values
};

struct ParameterSpec {
    ParameterKey key;          // "layer.stars.look.noise.0.cull"
    ParameterKey generic_key;  // "layer.look.noise.cull": the same in every layer, as in the manual
    std::string label;         // plain words
    std::string unit;          // "scene units", "degrees", "px", "" for plain numbers
    std::string help;          // one sentence
    ParameterType type = ParameterType::number;
    int components = 1;
    double min = -largest_number, max = largest_number;  // hard range, of every component
    bool below_max = false;                              // max itself is not allowed
    double slider_min = 0.0, slider_max = 1.0;
    bool any_order = false;  // a curve's x need not ascend
    Scale scale = Scale::linear;
    Animation animation = Animation::no;
    std::vector<std::string> choices;
    Value nothing;                  // how "not set" is written, where the field may be empty: "auto" or []
    std::string_view zero;          // what 0 means where it is no amount: "Auto", "Off"; empty: an amount
    std::string_view tab, section;  // where the window shows it: "Look", "Size"
    std::string row_label;          // the label below that section's title
    std::vector<Condition> conditions;  // it does something where all of these hold
};

/// A value that a parameter cannot take: what() is "expected ..., found ...".
struct ValueError : InputError {
    using InputError::InputError;
};

/// One parameter of one particular scene. Valid until a list of that scene (layers, meshes, noise, thickness
/// stops) changes its length.
struct Parameter {
    ParameterSpec spec;
    std::function<Value(const ParameterSpec&)> read;
    std::function<void(const Value&, const ParameterSpec&)> write;

    Value get() const { return read(spec); }
    /// Throws ValueError and changes nothing when the value does not fit.
    void set(const Value& value) const { write(value, spec); }
};

/// A list of tables whose elements are described one by one, as KEY.0.xxx, KEY.1.xxx.
struct ParameterList {
    ParameterKey key, generic_key;
    std::function<std::size_t()> size;
    std::function<void(std::size_t)> resize;  // new elements have their defaults
};

struct Description {
    std::vector<Parameter> parameters;
    std::vector<ParameterList> lists;
};

/// Whether a parameter does anything as the parameters that `find` gives stand; one that it does not know
/// (nullptr) decides nothing.
bool has_effect(const ParameterSpec& spec, const std::function<const Parameter*(const ParameterKey&)>& find);

/// "a number from 0 to 1", "3 numbers", "over, add or screen": completes "expected ...".
std::string expectation(const ParameterSpec& spec);

/// Animated values are numbers per component: booleans 0 or 1, choices their index, curves x0 y0 x1 y1 ...
std::vector<double> to_numbers(const ParameterSpec& spec, const Value& value);
/// The value nearest to these numbers that the parameter's type and range allow.
Value from_numbers(const ParameterSpec& spec, const std::vector<double>& numbers);

/// The paths of a file, files or pattern parameter, expanded and put below `folder`; names that stand for
/// themselves (built-in meshes) and empty ones stay. Frame patterns stay relative to the
/// scene unless `absolute_patterns`.
Value resolve_paths(const Value& value, const ParameterSpec& spec, const fs::path& folder,
                    bool absolute_patterns);

/// The inverse for a scene file in `folder`: relative where the path was, or where it lies below the folder.
/// resolve_paths(unresolve_paths(v)) == v.
Value unresolve_paths(const Value& value, const ParameterSpec& spec, const fs::path& folder);

}  // namespace astrosplat
