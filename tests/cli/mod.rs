//! The command from outside: exit statuses, messages, files.

mod baselines;
mod command;
mod commands;
mod epochs;
mod input;
mod processes;
mod rays;
mod report;
mod resume;
