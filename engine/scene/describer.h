// Builds a Description: a place in the tree of keys plus one call per field.
#pragma once

#include <fmt/format.h>

#include "scene/field.h"
#include "scene/scene.h"

namespace astrosplat {

/// A spec with its words; the describer puts the section before the key.
inline ParameterSpec spec(std::string key, std::string label, std::string unit, std::string help) {
    ParameterSpec result;
    result.key = std::move(key);
    result.label = std::move(label);
    result.unit = std::move(unit);
    result.help = std::move(help);
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
    Describer only_with(std::string name, std::vector<Value> values) const {
        Describer limited = *this;
        limited.conditions_.push_back({group_ / name, std::move(values), true});
        return limited;
    }

    /// Describes one field. Its type follows from the field, unless the spec says more (color, position,
    /// ...).
    template <class T>
    void operator()(ParameterSpec field_spec, T& field) const {
        Field<T>::describe(field_spec);
        place(field_spec, animated_);
        add(std::move(field_spec), field);
    }

    /// The same, but never (false) or always (true) animated, whatever the section says.
    template <class T>
    void operator()(ParameterSpec field_spec, T& field, bool animated) const {
        Field<T>::describe(field_spec);
        place(field_spec, animated);
        add(std::move(field_spec), field);
    }

    /// A parameter that is not one field: with its own way in and out; the spec names its type.
    void custom(ParameterSpec field_spec, std::function<Value(const ParameterSpec&)> get,
                std::function<void(const Value&, const ParameterSpec&)> set) const {
        place(field_spec, animated_);
        description_->parameters.push_back({std::move(field_spec), std::move(get), std::move(set)});
    }

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
    void place(ParameterSpec& field_spec, bool animated) const;

    template <class T>
    void add(ParameterSpec field_spec, T& field) const {
        T* const target = &field;
        description_->parameters.push_back(
            {std::move(field_spec),
             [target](const ParameterSpec& own) { return Field<T>::get(*target, own); },
             [target](const Value& value, const ParameterSpec& own) {
                 *target = Field<T>::set(value, own);
             }});
    }

    Description* description_;
    ParameterKey group_;
    std::string_view tab_, section_;  // literals
    std::vector<Condition> conditions_;
    bool animated_;
};

/// The keys of one layer; the describer stands at "layer.NAME".
void describe_layer(const Describer& d, LayerParams& layer);
void describe_look(const Describer& d, Look& look);
void describe_render(const Describer& d, LayerRender& render);

}  // namespace astrosplat
