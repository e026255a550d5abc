// Several machines in one: network namespaces joined by a wire of our own, or loopback where they are not
// permitted.
#pragma once

#include <string>
#include <vector>

namespace slosh::test {

/// One site a name. All are joined through one more namespace, "wire", in which the impairment relay runs.
/// Without the right to make namespaces every site is this machine itself.
class Sites {
 public:
  explicit Sites(std::vector<std::string> names);
  ~Sites();
  Sites(const Sites&) = delete;
  Sites& operator=(const Sites&) = delete;

  bool separate() const { return separate_; }
  /// `command` as it runs at `site` (or at "wire").
  std::vector<std::string> at(const std::string& site, std::vector<std::string> command) const;
  /// The site's own address.
  std::string address(const std::string& site) const;
  /// The wire's address as the site sees it.
  std::string wire_address(const std::string& site) const;

 private:
  int number(const std::string& site) const;
  std::string space(const std::string& site) const;
  bool build();
  void remove();

  std::vector<std::string> names_;
  std::string prefix_;
  bool separate_ = false;
};

}  // namespace slosh::test
