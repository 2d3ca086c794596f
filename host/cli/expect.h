// cli/expect.h: conditions on records, "missing<=0.04" or, for one method, "points.watertight==true".
#pragma once
#include <string>
#include <vector>

#include "cli/record.h"

namespace vitrail::cli {

class Expectation {
public:
    /// Throws Error (badOption) when it is none, or names no number or truth value of `sample`, a record with all fields.
    Expectation(const std::string& text, const Json& sample);

    const std::string& text() const { return text_; }
    const std::string& method() const { return method_; }  ///< empty: all
    /// False: does not speak of this record (another method, or a field that it has not).
    bool speaksOf(const Json& record) const;
    bool met(const Json& record) const;
    Json value(const Json& record) const { return record.at(field_); }

private:
    std::string text_, method_, field_, relation_;
    double number_ = 0;
    bool isTruth_ = false, truth_ = false;
};

/// Adds "expectations" to the document, says on standard error which are not met, and returns whether all are. Throws Error (badOption) for
/// one that speaks of none of the records.
bool judge(Json& document, const std::vector<Expectation>& expectations, const Json& records);

}  // namespace vitrail::cli
