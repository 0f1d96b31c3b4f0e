// Builds a Description: a place in the tree of keys plus one call per field.
#pragma once

#include <fmt/format.h>

#include "scene/field.h"
#include "scene/scene.h"

namespace astrosplat {

/// What a description says of a parameter beside its words; each writes itself into the spec.
namespace traits {

template <class T>
auto sets(T ParameterSpec::*member, T value) {
    return [member, value](ParameterSpec& s) { s.*member = value; };
}
/// The numbers allowed.
inline auto at_least(double lo) { return sets(&ParameterSpec::min, lo); }
inline auto within(double lo, double hi) {
    return [lo, hi](ParameterSpec& s) { s.min = lo, s.max = hi; };
}
inline auto below(double hi) {
    return [hi](ParameterSpec& s) { s.max = hi, s.below_max = true; };
}
inline auto slider(double lo, double hi) {
    return [lo, hi](ParameterSpec& s) { s.slider_min = lo, s.slider_max = hi; };
}
/// Both of them.
inline auto range(double lo, double hi) {
    return [lo, hi](ParameterSpec& s) { within(lo, hi)(s), slider(lo, hi)(s); };
}
inline auto logarithmic() { return sets(&ParameterSpec::scale, Scale::logarithmic); }
inline auto as(ParameterType type) { return sets(&ParameterSpec::type, type); }
inline auto components(int count) { return sets(&ParameterSpec::components, count); }
inline auto one_of(std::vector<std::string> names) { return sets(&ParameterSpec::choices, std::move(names)); }
/// How nothing is written.
inline auto or_auto() { return sets(&ParameterSpec::nothing, Value("auto")); }
inline auto or_no_text() { return sets(&ParameterSpec::nothing, Value("")); }
inline auto zero_is(std::string_view words) { return sets(&ParameterSpec::zero, words); }
/// Points that need not ascend.
inline auto in_any_order() { return sets(&ParameterSpec::any_order, true); }
inline auto shown_as(std::string short_label) {
    return sets(&ParameterSpec::row_label, std::move(short_label));
}
/// It does something only with, or never with, one of these values of its neighbour `name`.
inline auto condition(const char* name, std::vector<Value> values, bool wanted) {
    return [=](ParameterSpec& s) { s.conditions.push_back({name, values, wanted}); };
}
inline auto only_with(const char* name, std::vector<Value> values) {
    return condition(name, std::move(values), true);
}
inline auto never_with(const char* name, std::vector<Value> values) {
    return condition(name, std::move(values), false);
}

}  // namespace traits

/// A spec with its words; the describer puts the section before the key.
template <class... Traits>
ParameterSpec spec(const char* key, const char* label, const char* unit, const char* help,
                   const Traits&... traits) {
    ParameterSpec result;
    result.key = key;
    result.label = label;
    result.unit = unit;
    result.help = help;
    (traits(result), ...);
    return result;
}

class Describer {
  public:
    Describer(Description& description, ParameterKey group, bool animated)
        : description_(&description), group_(std::move(group)), animated_(animated) {}

    /// Describes what lies in the group `name` below this one.
    Describer in(const std::string& name, bool animated) const {
        Describer inner = *this;
        inner.group_ = group_ / name;
        inner.animated_ = animated;
        return inner;
    }

    /// The same place, shown in another section of the window.
    Describer shown_in(std::string_view tab, std::string_view section) const {
        Describer shown = *this;
        shown.tab_ = tab;
        shown.section_ = section;
        return shown;
    }

    /// The same place, where nothing has an effect unless the neighbour `name` has one of these values.
    Describer only_with(const std::string& name, std::vector<Value> values) const {
        return limited({group_ / name, std::move(values), true});
    }

    /// The same place, where nothing has an effect while the neighbour `name` has one of these values.
    Describer never_with(const std::string& name, std::vector<Value> values) const {
        return limited({group_ / name, std::move(values), false});
    }

    /// The same place, where parameters are animated whatever the group says.
    Describer animated() const {
        Describer moving = *this;
        moving.animated_ = true;
        return moving;
    }

    /// The same place, where no parameter is.
    Describer still() const {
        Describer fixed = *this;
        fixed.animated_ = false;
        return fixed;
    }

    /// Describes one field, by its words and traits as in spec(). Its type follows from the field, unless a
    /// trait says more (color, position, ...).
    template <class T, class... Traits>
    void operator()(T& field, const char* key, const char* label, const char* unit, const char* help,
                    const Traits&... traits) const {
        describe_field(field, spec(key, label, unit, help, traits...));
    }

    /// A parameter that is not one field: with its own way in and out; the spec names its type.
    void custom(ParameterSpec field_spec, std::function<Value(const ParameterSpec&)> get,
                std::function<void(const Value&, const ParameterSpec&)> set) const;

    /// A list of tables, each element described by `describe_element(describer, element)`.
    template <class T, class DescribeElement>
    void list(const std::string& key, std::vector<T>& elements, DescribeElement describe_element) const {
        std::vector<T>* const list = &elements;
        const ParameterKey place = group_ / key;
        description_->lists.push_back({place, place.generic(), [list] { return list->size(); },
                                       [list](std::size_t size) { list->resize(size); }});
        for (std::size_t i = 0; i < elements.size(); ++i)
            describe_element(in(fmt::format("{}.{}", key, i), animated_), elements[i]);
    }

  private:
    // Compiled once for a type, not for every set of words and traits.
    template <class T>
    void describe_field(T& field, ParameterSpec field_spec) const {
        Field<T>::describe(field_spec);
        T* const target = &field;
        custom(
            std::move(field_spec), [target](const ParameterSpec& own) { return Field<T>::get(*target, own); },
            [target](const Value& value, const ParameterSpec& own) { *target = Field<T>::set(value, own); });
    }

    Describer limited(Condition condition) const {
        Describer result = *this;
        result.conditions_.push_back(std::move(condition));
        return result;
    }

    Description* description_;
    ParameterKey group_;
    std::string_view tab_, section_;  // literals
    std::vector<Condition> conditions_;
    bool animated_;
};

}  // namespace astrosplat
