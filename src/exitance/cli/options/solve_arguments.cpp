#include <algorithm>
#include <memory>

#include "exitance/cli/options/option_kinds.hpp"
#include "exitance/methods/options/solve_option_table.hpp"

namespace exitance {

std::shared_ptr<std::vector<GivenOption>> declare_rows(CLI::App& app, std::span<const std::string_view> names) {
    const auto given = std::make_shared<std::vector<GivenOption>>();
    for (const OptionRow& row : solve_option_table()) {
        if (!names.empty() && std::find(names.begin(), names.end(), row.name) == names.end()) continue;
        CLI::Option* const option = row.value.type.empty()
                                        ? app.add_flag_callback(row.name,
                                                                [given, &row] {
                                                                    given->push_back({&row, ""});
                                                                })
                                        : app.add_option_function<std::string>(row.name,
                                                                               [given, &row](const std::string& word) {
                                                                                   given->push_back({&row, word});
                                                                               })
                                              ->type_name(row.value.type);
        option->description(help_of(row))->group(std::string(row.group.title));
    }
    return given;
}

void declare(CLI::App& app, SolveArguments& arguments) {
    declare_scene(app, arguments.scene);
    app.add_option("-o,--output", arguments.output, "Solution to write (.h5)")->type_name("FILE");
    const std::shared_ptr<std::vector<GivenOption>> given = declare_rows(app, {});
    declare_json(app, arguments);
    declare_progress(app, arguments);
    app.callback([given, &arguments] {
        Result<SolveRequest> request = make_request(*given);
        if (!request) throw CLI::ValidationError(request.error().where, request.error().message);
        static_cast<SolveRequest&>(arguments) = std::move(*request);
        arguments.limits.memory_limit = arguments.options.memory_limit_bytes;
    });
}

}  // namespace exitance
