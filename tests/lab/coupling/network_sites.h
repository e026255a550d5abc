// Several machines in one: network namespaces joined by a wire of our own.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace slosh {

/// One site a name. All are joined through one more namespace, "wire", in which the impairment relay runs.
/// Root is not needed where the kernel lets a user make a namespace of users. The namespaces are held by
/// processes that end with this one, however it ends, and nothing of them stays.
class NetworkSites {
 public:
  explicit NetworkSites(std::vector<std::string> names);
  ~NetworkSites();
  NetworkSites(const NetworkSites&) = delete;
  NetworkSites& operator=(const NetworkSites&) = delete;

  /// Why there are no sites here, in words; empty when all is well.
  const std::string& problem() const { return problem_; }
  /// `command` as it runs at `site` (or at "wire").
  std::vector<std::string> at(const std::string& site, std::vector<std::string> command) const;
  /// The site's own address.
  std::string address(const std::string& site) const;
  /// The wire's address as the site sees it.
  std::string wire_address(const std::string& site) const;

 private:
  struct Holder {
    std::string site;
    pid_t pid = -1;
    int keep = -1;  // it lives until this is closed
  };
  bool build();
  bool hold(const std::string& site, const std::vector<std::string>& unshare);
  bool run(const std::string& site, const std::string& command);
  void release();
  int number(const std::string& site) const;

  std::vector<std::string> names_;
  std::vector<Holder> holders_;
  bool own_users_ = false;  // a namespace of users was needed
  std::string problem_;
};

}  // namespace slosh
