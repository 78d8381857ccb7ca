#include "exitance/cli/options/option_kinds.hpp"

namespace exitance {
namespace {

/// Reads "7" or "5-8": numbers of variants, from 1.
VariantRange read_variants(const std::string& word) {
    const std::size_t dash = word.find('-');
    const auto number = [&](const std::string& text) {
        if (text.empty() || text.size() > 9 || text.find_first_not_of("0123456789") != std::string::npos ||
            std::stoul(text) == 0)
            throw CLI::ValidationError("--run",
                                       fmt::format("must be a number from 1, or a range such as 5-8, not '{}'", word));
        return std::stoul(text);
    };
    VariantRange range;
    range.first = number(word.substr(0, dash));
    range.last = dash == std::string::npos ? range.first : number(word.substr(dash + 1));
    if (range.last < range.first)
        throw CLI::ValidationError("--run", fmt::format("the range '{}' contains no variants", word));
    return range;
}

}  // namespace

void declare(CLI::App& app, SweepArguments& arguments) {
    app.add_option("PLAN", arguments.plan, "Plan of the sweep (.toml)")->type_name("PLAN")->required();
    app.add_flag("--list", arguments.list, "Print all variants with their states: done, running, failed or to do");
    app.add_option_function<std::string>(
           "--run", [&arguments](const std::string& word) { arguments.run = read_variants(word); },
           "Run variant K, or variants A to B, unless they are done. Use it in jobs of a cluster")
        ->type_name("K|A-B");
    add_count(app, "--local", arguments.local, 1, "Run all variants that are not done, N at a time")
        ->excludes(app.get_option("--run"));
    app.add_flag("--collect", arguments.collect, "Write the table of results: one row per variant");
    app.add_option("-o,--output", arguments.outputs,
                   "File for --collect (.csv or .h5); may be given several times. Default: results.csv and results.h5 "
                   "in the folder of the sweep")
        ->type_name("FILE")
        ->expected(1)
        ->take_all();
    declare_json(app, arguments);
    declare_work(app, arguments, arguments.threads);
    app.get_option("--threads")
        ->description("Threads of every step that does not choose them itself. Default: all cores, divided by N");
}

}  // namespace exitance
