#include "core/parallel/packed_error.hpp"

#include <fmt/format.h>

#include <new>
#include <utility>

#include "core/error.hpp"

namespace talus {

namespace {

enum class Kind : char { scene = 's', run = 'r', stopped = 't', environment = 'e', other = 'o', memory = 'm', foreign = 'f' };

void put(std::string_view part, std::string& text) { text += fmt::format("{} {}", part.size(), part); }

std::string take(std::string_view& text)
{
  const std::size_t space = text.find(' ');
  const std::size_t bytes = std::stoul(std::string(text.substr(0, space)));
  std::string part(text.substr(space + 1, bytes));
  text.remove_prefix(space + 1 + bytes);
  return part;
}

std::string packed(Kind kind, std::string_view message)
{
  std::string text(1, static_cast<char>(kind));
  put(message, text);
  return text;
}

}  // namespace

std::string packed(const std::exception_ptr& error)
{
  try {
    std::rethrow_exception(error);
  } catch (const SceneErrors& e) {
    std::string text(1, static_cast<char>(Kind::scene));
    for (const auto& [where, message, source_line] : e.problems())
      for (const std::string& part :
           {where.file, std::to_string(where.line), std::to_string(where.column), where.path, message, source_line})
        put(part, text);
    return text;
  } catch (const RunError& e) {
    return packed(Kind::run, e.what());
  } catch (const Stopped& e) {
    return packed(Kind::stopped, e.what());
  } catch (const EnvironmentError& e) {
    return packed(Kind::environment, e.what());
  } catch (const Error& e) {
    return packed(Kind::other, e.what());
  } catch (const std::bad_alloc& e) {
    return packed(Kind::memory, e.what());
  } catch (const std::exception& e) {
    return packed(Kind::foreign, e.what());
  } catch (...) {
    return packed(Kind::foreign, "an exception of an unknown kind");
  }
}

void throw_packed(std::string_view text)
{
  const auto kind = static_cast<Kind>(text.front());
  text.remove_prefix(1);
  if (kind == Kind::scene) {
    std::vector<SceneError> problems;
    while (!text.empty()) {
      SceneError& problem = problems.emplace_back();
      problem.where.file = take(text);
      problem.where.line = std::stoi(take(text));
      problem.where.column = std::stoi(take(text));
      problem.where.path = take(text);
      problem.message = take(text);
      problem.source_line = take(text);
    }
    throw SceneErrors(std::move(problems));
  }
  const std::string message = take(text);
  switch (kind) {
    case Kind::run: throw RunError(message);
    case Kind::stopped: throw Stopped(message);
    case Kind::environment: throw EnvironmentError(message);
    case Kind::other: throw Error(message);
    case Kind::memory: throw std::bad_alloc();
    default: throw std::runtime_error(message);
  }
}

}  // namespace talus
