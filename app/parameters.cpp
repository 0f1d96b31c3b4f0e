// parameters: every key of a scene file with default, range and meaning, from the one description
// in the engine.
#include "parameters.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <variant>

#include "report.h"
#include "scene/describe.h"

namespace astrosplat {
namespace {

Report to_report(const Value& value) {
    if (const Value::List* list = value.list()) {
        Report items = Report::array();
        for (const Value& item : *list) items.push_back(to_report(item));
        return items;
    }
    if (const std::string* text = value.text()) return *text;
    if (const bool* flag = std::get_if<bool>(&value.data)) return *flag;
    if (const std::int64_t* whole = std::get_if<std::int64_t>(&value.data)) return *whole;
    return value.number();
}

Report to_report(const ParameterRow& row) {
    const ParameterSpec& spec = row.spec;
    Report report = {
        {"key", spec.key.text()}, {"type", name_of(spec.type)}, {"default", to_report(row.standard)},
        {"unit", spec.unit},      {"label", spec.label},        {"help", spec.help}};
    if (is_numeric(spec.type)) {
        report["min"] = spec.min;
        report["max"] = spec.max;
    }
    if (!spec.zero.empty()) report["zero"] = std::string(spec.zero);
    if (!spec.choices.empty()) report["choices"] = spec.choices;
    report["animated"] = name_of(spec.animation);
    return report;
}

}  // namespace

int run_parameters(const ParametersOptions& options) {
    if (!options.json) {
        fmt::print("{}", parameter_table());
        return exit_done;
    }
    Report rows = Report::array();
    for (const ParameterRow& row : parameter_rows()) rows.push_back(to_report(row));
    print_report(rows, true);
    return exit_done;
}

}  // namespace astrosplat
