#include "planner/app/usage.h"

#include <algorithm>
#include <vector>

#include "collision/core/spelling.h"

namespace corridor::app {
namespace {

/// Returns a message on a word or an option that the command does not take, with the nearest name
/// of an option; "" if there is no such word. (CLI11's own message lists the words in reverse, and
/// suggests nothing.) Words before the command, or after a --, are in `program.remaining()`.
std::string unknownWord(const CLI::App& program, const CLI::App& command) {
  std::vector<std::string> words = command.remaining();
  if (words.empty()) words = program.remaining();
  if (words.empty()) return "";
  const auto option = std::find_if(words.begin(), words.end(),
                                   [](const std::string& word) { return word.starts_with('-'); });
  if (option == words.end()) return "unexpected word " + quotedWord(words.back());
  const std::string name = option->substr(0, option->find('='));
  std::vector<std::string> names;
  for (const CLI::Option* known : command.get_options())
    for (const std::string& longName : known->get_lnames()) names.push_back("--" + longName);
  return "unknown option " + quotedWord(name) + didYouMean(name, names);
}

/// Returns a message on an option that is given several times but may be given only once; "" if
/// there is no such option.
std::string repeatedOption(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options())
    if (option->get_items_expected_max() == 1 && option->count() > 1)
      return option->get_name() + " is given " + std::to_string(option->count()) +
             " times; once is enough";
  return "";
}

/// Returns a message on a word that is no command of `app`. The message lists the commands.
std::string unknownCommand(const CLI::App& app, const std::string& word) {
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    commands.push_back(command->get_name());
  return "unknown command " + quotedWord(word) + didYouMean(word, commands) +
         "; there are: " + joined(commands);
}

}  // namespace

void refuseEmptyValues(CLI::App& program) {
  for (CLI::App* command : program.get_subcommands({})) {
    for (CLI::Option* option : command->get_options())
      if (option->get_items_expected_max() > 0)
        option->check(CLI::Validator(
            [](std::string& text) { return text.empty() ? std::string("is empty") : ""; }, ""));
    refuseEmptyValues(*command);
  }
}

std::string usageFault(const CLI::App& program, const CLI::ParseError& error,
                       const std::string& firstWord) {
  auto given = program.get_subcommands();
  if (!given.empty()) {
    const CLI::App* command = given[0];
    std::string name = command->get_name(), fault;
    while (!(given = command->get_subcommands()).empty()) {  // a command of a command: new robot
      command = given[0];
      name += " " + command->get_name();
    }
    const std::vector<std::string> words = command->remaining();
    const bool hasSubcommands =
        !command->get_subcommands([](const CLI::App*) { return true; }).empty();
    if (dynamic_cast<const CLI::ExtrasError*>(&error)) fault = unknownWord(program, *command);
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error)) fault = repeatedOption(*command);
    if (hasSubcommands && !words.empty() && !words.front().starts_with('-'))
      fault = unknownCommand(*command, words.front());
    if (fault.empty()) fault = error.what();
    return fault + "; see corridor " + name + " --help";
  }
  if (firstWord.empty() || firstWord[0] == '-')
    return error.what() + std::string("; see corridor --help");
  return unknownCommand(program, firstWord);
}

}  // namespace corridor::app
