#include "cli/expect.h"

#include <charconv>

#include <vitrail/core/error.h>

#include "cli/verb.h"

namespace vitrail::cli {

namespace {

std::string trimmed(const std::string& text) {
    const std::size_t first = text.find_first_not_of(" \t");
    return first == std::string::npos ? std::string() : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

[[noreturn]] void fail(const std::string& text, const std::string& why, const std::string& remedy) {
    throw Error(ErrorCode::badOption, {.what = "--expect \"" + text + "\": " + why, .remedy = remedy});
}

}  // namespace

Expectation::Expectation(const std::string& text, const Json& sample) : text_(text) {
    const std::size_t at = text.find_first_of("<>=!");
    const std::string shape = "FIELD and one of < <= == >= > and a number, true or false, as in 'missing<=0.04'";
    if (at == std::string::npos) fail(text, "there is no comparison", shape);
    const std::size_t after = text.find_first_not_of("<>=!", at);
    relation_ = text.substr(at, after - at);
    if (relation_ != "<" && relation_ != "<=" && relation_ != "==" && relation_ != ">=" && relation_ != ">")
        fail(text, "\"" + relation_ + "\" is no comparison", shape);

    field_ = trimmed(text.substr(0, at));
    if (const std::size_t dot = field_.find('.'); dot != std::string::npos) {
        method_ = trimmed(field_.substr(0, dot));
        field_ = trimmed(field_.substr(dot + 1));
    }
    std::string fields;
    for (const auto& [name, value] : sample.items())
        if (value.is_number() || value.is_boolean()) fields += (fields.empty() ? "" : " ") + name;
    if (!sample.contains(field_) || !(sample[field_].is_number() || sample[field_].is_boolean()))
        fail(text, "there is no number \"" + field_ + "\" in a record", fields);

    const std::string wanted = after == std::string::npos ? std::string() : trimmed(text.substr(after));
    isTruth_ = sample[field_].is_boolean();
    if (isTruth_) {
        truth_ = wanted == "true";
        if ((wanted != "true" && wanted != "false") || relation_ != "==")
            fail(text, field_ + " is true or false", "'" + field_ + "==true' or '" + field_ + "==false'");
        return;
    }
    const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), number_);
    if (error != std::errc() || end != wanted.data() + wanted.size()) fail(text, "\"" + wanted + "\" is no number", shape);
}

bool Expectation::speaksOf(const Json& record) const {
    return record.contains(field_) && (method_.empty() || record.at("method") == method_);
}

bool Expectation::met(const Json& record) const {
    if (isTruth_) return record.at(field_).get<bool>() == truth_;
    const double value = record.at(field_).get<double>();
    if (relation_ == "<") return value < number_;
    if (relation_ == "<=") return value <= number_;
    if (relation_ == "==") return value == number_;
    if (relation_ == ">=") return value >= number_;
    return value > number_;
}

bool judge(Json& document, const std::vector<Expectation>& expectations, const Json& records) {
    if (expectations.empty()) return true;
    bool all = true;
    Json verdicts = Json::array();
    for (const Expectation& expectation : expectations) {
        bool spoke = false;
        for (const Json& record : records) {
            if (!expectation.speaksOf(record)) continue;
            spoke = true;
            const bool met = expectation.met(record);
            verdicts.push_back(
                {{"expect", expectation.text()}, {"method", record.at("method")}, {"value", expectation.value(record)}, {"met", met}});
            if (met) continue;
            all = false;
            note("vitrail: not met by " + record.at("method").get<std::string>() + ": " + expectation.text() + " (it is " +
                 expectation.value(record).dump() + ")");
        }
        if (!spoke)
            throw Error(ErrorCode::badOption, {.what = "--expect \"" + expectation.text() + "\" speaks of nothing that was compared",
                                               .remedy = "a method and a field that are in the table"});
    }
    document["expectations"] = verdicts;
    document["met"] = all;
    return all;
}

}  // namespace vitrail::cli
