// parameters: every key of a scene file with default, range and meaning, from the one description in the
// engine; of one scene also what they are there.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <variant>

#include "cli.h"
#include "core/file.h"
#include "exit.h"
#include "scene/describe.h"
#include "scene/load.h"

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

Report to_report(const ParameterSpec& spec, const char* value_name, const Value& value) {
    Report report = {{"key", spec.key.text()}, {"type", name_of(spec.type)}, {value_name, to_report(value)},
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

/// Keys as --set takes them, with their values; also of a scene on its way to becoming one.
std::vector<ParameterRow> rows_of(const std::filesystem::path& name) {
    const std::filesystem::path file = find_by_name("scenes", name);
    Scene scene = parse_unchecked(read_file(file), file);
    std::vector<ParameterRow> rows;
    for (const Parameter& parameter : describe(scene).parameters)
        rows.push_back({parameter.spec, parameter.get()});
    return rows;
}

std::string value_table(const std::vector<ParameterRow>& rows) {
    std::string table;
    for (const ParameterRow& row : rows)
        table += fmt::format("{:<44} = {}\n", row.spec.key, to_toml(row.value));
    return table;
}

struct ParametersOptions {
    bool names = false;
};

/// `options.input`: a scene's file or short name; empty: keys as the manual has them.
int run_parameters(const CommandOptions& options, const ParametersOptions& own) {
    const bool of_scene = !options.input.empty();
    const std::vector<ParameterRow> rows = of_scene ? rows_of(options.input) : parameter_rows();
    if (options.json) {
        Report report = Report::array();
        for (const ParameterRow& row : rows)
            report.push_back(to_report(row.spec, of_scene ? "value" : "default", row.value));
        print_report(report, true);
    } else if (own.names) {
        for (const ParameterRow& row : rows) fmt::print("{}\n", row.spec.key);
    } else {
        fmt::print("{}", of_scene ? value_table(rows) : parameter_table());
    }
    return exit_done;
}

}  // namespace

void add_parameters(CLI::App& app, Invocation& call) {
    auto [command, own] =
        add_command(app, call, "parameters", "Lists every key of a scene file", run_parameters);
    add_value(command, "SCENE", call.options.input, "SCENE",
              "Lists the keys of this scene as --set takes them, with their values");
    command.add_flag("--names", own.names, "Prints only the keys");
    add_json(command, call.options);
}

}  // namespace astrosplat
