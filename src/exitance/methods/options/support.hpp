#pragma once

#include <span>
#include <string>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/methods/options/option_row.hpp"

namespace exitance {

/// The form that the options select.
Form form_of(const SolveRequest& request);

/// Does the way support the option with the value that it has in the request?
bool supports(const OptionRow& row, const SolveRequest& request, Way way);

/// The methods that support an option with this value (empty: with any) in a form, as "hierarchical, wavelet; matrix
/// with
/// --basis constant". Empty: none.
std::string supporting_methods(const OptionRow& row, Form form, const std::string& value = "");

/// The way that carries out a request: its form, with its method or, for `auto`, the first method that supports all
/// options. Error (usage): an option that is not supported, options that need or exclude one another; the message says
/// which, and which methods support the option.
Result<Way> find_way(const SolveRequest& request);
/// Like find_way(request), in a given form.
Result<Way> find_way(const SolveRequest& request, Form form);

/// Does the method support all options? If reflections are counted, `matrix` replaces other methods.
bool supports_all(Method method, const SolveOptions& options);

/// The first method that supports all options, for `auto`; `automatic` if none does.
Method first_supporting(const SolveOptions& options);

/// An error if an option that is set does not work over several processes.
Result<void> check_one_process(const SolveRequest& request);

}  // namespace exitance
