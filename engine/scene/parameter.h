// What is known of one parameter: its key, its words for people, its range, whether it may be animated; and a
// handle that reads and writes it in the struct it lives in. describe.h makes these, everything else only
// reads them.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/error.h"
#include "scene/parameter_key.h"
#include "scene/value.h"

namespace astrosplat {

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
    curve      // [[x, y], ...] with x ascending
};

enum class Scale { linear, logarithmic };

/// Whether a parameter may be a key of [animation], and how its values follow each other.
enum class Animation { no, steps, yes };

struct ParameterSpec {
    ParameterKey key;          // "layer.stars.look.noise.0.cull"
    ParameterKey generic_key;  // "layer.look.noise.cull": the same in every layer, as in the manual
    std::string label;         // plain words
    std::string unit;          // "scene units", "degrees", "px", "" for plain numbers
    std::string help;          // one sentence
    ParameterType type = ParameterType::number;
    int components = 1;
    double min = -std::numeric_limits<double>::infinity();  // hard range, of every component
    double max = std::numeric_limits<double>::infinity();
    bool above_min = false;  // min itself is not allowed
    bool below_max = false;  // max itself is not allowed
    double slider_min = 0.0, slider_max = 1.0;
    Scale scale = Scale::linear;
    Animation animation = Animation::no;
    std::vector<std::string> choices;
    Value nothing;  // how "not set" is written, where the field may be empty: "auto" or []

    // For descriptions: each sets one of the above and returns the spec.
    ParameterSpec& range(double lo, double hi);  // slider too
    ParameterSpec& at_least(double lo);
    ParameterSpec& above(double lo);
    ParameterSpec& below(double hi);
    ParameterSpec& slider(double lo, double hi);
    ParameterSpec& logarithmic();
    ParameterSpec& as(ParameterType kind);
    ParameterSpec& one_of(std::vector<std::string> names);
    ParameterSpec& or_auto();     // "auto" is how nothing is written
    ParameterSpec& or_no_text();  // "" is
};

/// A value that a parameter cannot take: what() is "expected ..., found ...".
struct ValueError : InputError {
    using InputError::InputError;
};

/// One parameter of one particular scene. Valid until a list of that scene (layers, meshes, noise, thickness
/// keys) changes its length.
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

/// "a number from 0 to 1", "3 numbers", "over, add or screen": completes "expected ...".
std::string expectation(const ParameterSpec& spec);

/// Keyed values are numbers per component: booleans 0 or 1, choices their index, curves x0 y0 x1 y1 ...
std::vector<double> to_numbers(const ParameterSpec& spec, const Value& value);
/// The value nearest to these numbers that the parameter's type and range allow.
Value from_numbers(const ParameterSpec& spec, const std::vector<double>& numbers);

}  // namespace astrosplat
