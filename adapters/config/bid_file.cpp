#include "config/bid_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "config/read_file.hpp"
#include "config/shipped_bids.hpp"
#include "config/yaml_text.hpp"
#include "gridmerge/base/number_text.hpp"

namespace gridmerge {
namespace {

using Kind = YamlEntry::Kind;

class BidReader {
 public:
  explicit BidReader(const std::string& file) : problems_(file) {}

  BidBook read(const std::vector<YamlEntry>& entries) {
    BidBook book;
    problems_.add_repeated_keys(entries);
    for (const YamlEntry& entry : entries) {
      if (entry.key == "methods") {
        read_methods(entry, book);
      } else if (entry.key == "second_chance") {
        book.second_chance = weights(entry, second_chance_names());
      } else {
        problems_.add_unknown_key(entry, {"methods", "second_chance"});
      }
    }
    problems_.throw_if_any();
    return book;
  }

 private:
  void read_methods(const YamlEntry& methods, BidBook& book) {
    if (!is_mapping(methods, "methods, each with what is expected of it")) {
      return;
    }
    for (const YamlEntry& method : methods.children) {
      if (!is_mapping(method, "success and log_seconds")) {
        continue;
      }
      BidModel model{.method = method.key, .success = {}, .log_seconds = {}};
      for (const YamlEntry& part : method.children) {
        if (part.key == "success") {
          model.success = weights(part, inputs_);
        } else if (part.key == "log_seconds") {
          model.log_seconds = weights(part, inputs_);
        } else {
          problems_.add_unknown_key(part, {"success", "log_seconds"});
        }
      }
      for (const char* key : {"success", "log_seconds"}) {
        if (find_entry(method.children, key) == nullptr) {
          problems_.add(method.line, method.key + ": key '" + key + "' is missing");
        }
      }
      book.methods.push_back(std::move(model));
    }
  }

  WeightedSum weights(const YamlEntry& entry, const std::vector<std::string>& known) {
    WeightedSum sum;
    if (!is_mapping(entry, "inputs with their weights")) {
      return sum;
    }
    for (const YamlEntry& weight : entry.children) {
      if (std::find(known.begin(), known.end(), weight.key) == known.end()) {
        problems_.add_unknown_key(weight, known);
        continue;
      }
      double value = 0;
      const char* end = weight.text.data() + weight.text.size();
      const auto [rest, error] = std::from_chars(weight.text.data(), end, value);
      if (weight.kind != Kind::kScalar || error != std::errc{} || rest != end || !std::isfinite(value)) {
        problems_.add(weight.line, weight.key + " = '" + weight.text + "': must be a finite number");
      }
      sum.weights.emplace_back(weight.key, value);
    }
    return sum;
  }

  bool is_mapping(const YamlEntry& entry, const std::string& of_what) {
    if (entry.kind != Kind::kMapping) {
      problems_.add(entry.line, entry.key + ": must hold " + of_what);
      return false;
    }
    problems_.add_repeated_keys(entry.children);
    return true;
  }

  FileProblems problems_;
  std::vector<std::string> inputs_ = BidInputs::names();
};

std::string weights_yaml(const std::string& key, const WeightedSum& sum, const std::string& indent) {
  std::string text = indent + key + ": {";
  for (const auto& [name, weight] : sum.weights) {
    text += (text.back() == '{' ? "" : ", ") + name + ": " + exact(weight);
  }
  return text + "}\n";
}

}  // namespace

BidBook read_bids(const std::filesystem::path& yaml) {
  constexpr std::uintmax_t kMaxBytes = 1 << 20;
  return parse_bids(read_file(yaml, kMaxBytes), yaml.string());
}

BidBook parse_bids(std::string_view text, const std::string& name) {
  return BidReader(name).read(parse_yaml_tree(text, name));
}

const BidBook& shipped_bids() {
  static const BidBook book = parse_bids(shipped_bids_yaml(), "configs/learned/bids.yaml");
  return book;
}

std::string to_yaml(const BidBook& book) {
  std::string text = book.methods.empty() ? "methods: {}\n" : "methods:\n";
  for (const BidModel& model : book.methods) {
    text += "  " + yaml_word(model.method) + ":\n" + weights_yaml("success", model.success, "    ") +
            weights_yaml("log_seconds", model.log_seconds, "    ");
  }
  return text + weights_yaml("second_chance", book.second_chance, "");
}

}  // namespace gridmerge
