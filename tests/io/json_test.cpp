// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/bytes/json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "io/bytes/json_place.h"
#include "support/error_of.h"

namespace axial::io {
namespace {

using Ordered = nlohmann::ordered_json;

TEST(JsonText, ReadsBackWhatItWrote) {
  const Ordered json{{"z", {1, 2.5, nullptr}}, {"a", "\"\\ \n \u00b0"}, {"m", Ordered::object()}};
  for (const int indent : {-1, 0, 2}) EXPECT_EQ(json_from(to_text(json, indent)), json) << indent;
  EXPECT_EQ(to_text(json).find('\n'), std::string::npos);
  EXPECT_EQ(to_text(Ordered{{"z", 1}, {"a", 2}}), R"({"z":1,"a":2})");
}

TEST(JsonText, ReplacesBytesThatAreNotUtf8) {
  EXPECT_EQ(to_text(Ordered("a\xff!")), "\"a\xef\xbf\xbd!\"");
}

TEST(JsonText, IsNullWhereItIsMalformed) {
  for (const char* text : {"", "{", "{\"a\": }", "[1] 2", "nul", "\"\xff\""})
    EXPECT_TRUE(json_from(text).is_null()) << text;
}

nlohmann::json content() {
  return {{"n", 2.5},
          {"t", "a"},
          {"e", ""},
          {"f", true},
          {"l", {1, 2, 3}},
          {"z", nullptr},
          {"o", {{"list", {{{"x", -1}}}}}}};
}

TEST(JsonPlaces, ReadValuesOfTheirType) {
  const nlohmann::json json = content();
  const JsonPlace whole = JsonPlace::of_file(json, "f.json");
  EXPECT_EQ(whole.number("n"), 2.5);
  EXPECT_EQ(whole.name("t"), "a");
  EXPECT_EQ(whole.text("e"), "");
  EXPECT_TRUE(whole.flag("f"));
  EXPECT_EQ(whole.at("l").numbers(3), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(whole.at("l").vector(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(whole.at("o").elements("list")[0].number("x"), -1);
  EXPECT_EQ(whole.keys(), (std::vector<std::string>{"e", "f", "l", "n", "o", "t", "z"}));
}

TEST(JsonPlaces, TakeOtherValuesForKeysThatAreMissingOrNull) {
  const nlohmann::json json = content();
  const JsonPlace whole = JsonPlace::of_file(json, "f.json");
  EXPECT_TRUE(whole.has("z"));
  EXPECT_FALSE(whole.has_value("z"));
  EXPECT_FALSE(whole.at("n").has("x")) << "a number has no keys";
  for (const char* key : {"z", "missing"}) {
    EXPECT_EQ(whole.number_or(key, 7), 7);
    EXPECT_FALSE(whole.flag_or_false(key));
    EXPECT_TRUE(whole.elements_or_none(key).empty());
  }
  EXPECT_EQ(whole.number_or("n", 7), 2.5);
  EXPECT_TRUE(whole.flag_or_false("f"));
  EXPECT_EQ(whole.elements_or_none("l").size(), 3u);
}

TEST(JsonPlaces, ErrorsNameThePlaceTheValueAndTheExpectedType) {
  const nlohmann::json json = content(), list = nlohmann::json::array();
  const JsonPlace whole = JsonPlace::of_file(json, "f.json"), object{json, "f.json: lens"};
  const auto error = [](auto read) { return test::error_of(read); };
  EXPECT_EQ(error([&] { whole.number("t"); }), "f.json: t is \"a\", expected a number");
  EXPECT_EQ(error([&] { object.text("z"); }), "f.json: lens.z is null, expected a text");
  EXPECT_EQ(error([&] { whole.name("e"); }),
            "f.json: e is \"\", expected a text that is not empty");
  EXPECT_EQ(error([&] { whole.flag("n"); }), "f.json: n is 2.5, expected true or false");
  EXPECT_EQ(error([&] { whole.at("l").numbers(2); }), "f.json: l is [1,2,3], expected 2 numbers");
  EXPECT_EQ(error([&] { whole.elements("n"); }), "f.json: n is 2.5, expected a list");
  EXPECT_EQ(error([&] { whole.at("o").elements("list")[0].at("x").number_from_0(); }),
            "f.json: o.list[0].x is -1, expected a number of at least 0");
  EXPECT_EQ(error([&] { whole.at("y"); }), "f.json: y is missing");
  EXPECT_EQ(error([&] { object.at("y"); }), "f.json: lens.y is missing");
  EXPECT_EQ(error([&] { JsonPlace::of_file(list, "f.json").at("y"); }),
            "f.json: is [], expected an object in braces");
  EXPECT_EQ(error([&] { whole.at("o").require_object({"other"}); }),
            "f.json: o: unknown key 'list'");
  EXPECT_EQ(error([&] { whole.require_object({"n", "t"}); }), "f.json: unknown key 'e'");
  EXPECT_EQ(error([&] { whole.require_version_1(); }), "f.json: version is missing");
}

TEST(JsonPlaces, ErrorsShowTheBeginOfLongValues) {
  const nlohmann::json json(std::string(1000, 'a'));
  EXPECT_EQ(test::error_of([&] { JsonPlace::of_file(json, "f").number(); }),
            "f: is \"" + std::string(59, 'a') + "..., expected a number");
}

}  // namespace
}  // namespace axial::io
