// The udev rule that lets whoever sits at the machine open devices: where it goes, and how it gets there.
#pragma once

#include <string>

namespace slosh {

/// `--install-udev-rule`: writes it to `file`, and where that is the machine's own place has udev take it up
/// at once. The exit code.
int install_rule(const std::string& file);

/// What follows a list of devices of which some may not be opened: the rule, and the command that puts it in
/// place. Where somebody sits at a terminal they are asked whether that is to be done now, and only a yes
/// runs it, through sudo where this user may not write there. True when the rule is in place by that.
bool offer_rule(const std::string& file);

}  // namespace slosh
