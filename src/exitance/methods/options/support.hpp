#pragma once

#include <span>
#include <string>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/methods/options/option_row.hpp"

namespace exitance {

/// The form that the options select.
Form form_of(const SolveOptions& options);

/// True if the method and form support the option with its value in the request.
bool supports(const OptionRow& row, const SolveRequest& request, MethodForm method_form);

/// Names of the methods that support an option with a value (empty: with any value) in a form, such as "hierarchical,
/// wavelet; matrix with --basis constant". Empty: no method.
std::string supporting_methods(const OptionRow& row, Form form, const std::string& value = "");

/// Method and form that carry out a request: its form, with its method or, for `auto`, the first method that supports
/// all options. Error (usage): an option that is not supported, or options that need or exclude one another. The
/// message names the options and the methods that support them.
Result<MethodForm> find_method_form(const SolveRequest& request);
/// Like find_method_form(request), in a given form.
Result<MethodForm> find_method_form(const SolveRequest& request, Form form);

/// Options with the method of the published form that they select, or unchanged ones. Error (usage): the form does not
/// support an option.
Result<SolveOptions> with_published_method(SolveOptions options);

/// True if the method supports all options. If the number of reflections is limited, `matrix` replaces most methods, as
/// in find_method_form().
bool supports_all(Method method, const SolveOptions& options);

/// The first method that supports all options, for `auto`; `automatic` if none does.
Method first_supporting(const SolveOptions& options);

/// An error if an option that is set does not work over several processes.
Result<void> check_one_process(const SolveRequest& request);

}  // namespace exitance
