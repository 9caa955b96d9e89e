//! `piola mcp`: a server of the Model Context Protocol, by which assistants check, run and explain cases.
//!
//! Messages are JSON-RPC 2.0, one a line, over the standard input and output. Nothing else is spoken to, and nothing is
//! written outside of `results/` in one folder. Calls of tools are served one after the other; a cancelled one is stopped, or
//! not begun, and has no answer. At the end of the input a run is stopped.

use std::io::{self, BufRead, Read, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use serde_json::{Value, json};

use crate::exit::{Exit, Fault};
use crate::interrupt;
use tools::{Answer, Tools};

mod tools;

/// Versions of the protocol in which what is used here is the same, the newest first.
const VERSIONS: [&str; 2] = ["2025-06-18", "2024-11-05"];

/// What an assistant is told about the server.
const INSTRUCTIONS: &str = "piola computes the motion of solids and fluids by smoothed particle \
    hydrodynamics from a case file in TOML. `schema` lists the keys; ask it for one key at a time. Write a case, `check` \
    it until it has no faults and its plan (particles, steps, wall time) is as wanted, then `run` it and read its `report`.";

/// Time between looks for the end of the input and for signals.
const LOOK: Duration = Duration::from_millis(50);
/// Longest message in bytes.
const LONGEST: u64 = 16 << 20;

/// Errors of JSON-RPC.
const PARSE_ERROR: i32 = -32_700;
const INVALID_REQUEST: i32 = -32_600;
const METHOD_NOT_FOUND: i32 = -32_601;
const INVALID_PARAMS: i32 = -32_602;
const INTERNAL_ERROR: i32 = -32_603;

/// A call of a tool that has not been answered yet.
struct Call {
    id: Value,
    params: Value,
    stop: Arc<AtomicBool>,
}

/// The calls that wait or are served, by which they are stopped.
type Pending = Arc<Mutex<Vec<(Value, Arc<AtomicBool>)>>>;

/// Serves until the input ends, or until it is told to stop.
pub fn serve(folder: &Path) -> Result<Exit, Fault> {
    let tools = Tools::new(folder)?;
    let told = interrupt::listen();
    let pending = Pending::default();
    let (sender, calls) = channel();
    // Input is read while a run goes on. The threads end with the program.
    let (known, ended) = (Arc::clone(&pending), Arc::clone(&told));
    thread::spawn(move || {
        read(&mut io::stdin().lock(), &sender, &known);
        ended.store(true, Ordering::SeqCst);
    });
    let (known, ended) = (Arc::clone(&pending), Arc::clone(&told));
    thread::spawn(move || {
        while !ended.load(Ordering::SeqCst) {
            thread::sleep(LOOK);
        }
        locked(&known).iter().for_each(|(_, stop)| stop.store(true, Ordering::SeqCst));
    });
    serve_calls(&calls, &tools, &pending, &told)?;
    Ok(Exit::Success)
}

fn locked<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Reads messages: answers those that need no work, and passes calls of tools on.
fn read(input: &mut impl BufRead, calls: &Sender<Call>, pending: &Pending) {
    let mut line = Vec::new();
    loop {
        line.clear();
        match input.by_ref().take(LONGEST).read_until(b'\n', &mut line) {
            Ok(0) | Err(_) => return,
            Ok(_) if line.len() as u64 == LONGEST => {
                let message = format!("a message is longer than {LONGEST} bytes");
                let _ = send(&failure(&Value::Null, PARSE_ERROR, &message));
                return;
            }
            Ok(_) if line.iter().all(u8::is_ascii_whitespace) => continue,
            Ok(_) => {}
        }
        let answer = match serde_json::from_slice::<Value>(&line) {
            Ok(message) => take(&message, calls, pending),
            Err(error) => Some(failure(&Value::Null, PARSE_ERROR, &format!("not JSON: {error}"))),
        };
        if answer.is_some_and(|answer| send(&answer).is_err()) {
            return;
        }
    }
}

/// Takes a message, and answers it if it is no call of a tool.
fn take(message: &Value, calls: &Sender<Call>, pending: &Pending) -> Option<Value> {
    let (id, params) = (&message["id"], &message["params"]);
    let Some(method) = message["method"].as_str() else {
        let is_response = message["result"] != Value::Null || message["error"] != Value::Null;
        let text = "a request is an object with a `method`";
        return (!is_response).then(|| failure(id, INVALID_REQUEST, text));
    };
    if method == "notifications/cancelled" {
        let waiting = locked(pending);
        let meant = waiting.iter().filter(|(id, _)| *id == params["requestId"]);
        meant.for_each(|(_, stop)| stop.store(true, Ordering::SeqCst));
    }
    if id.is_null() {
        return None;
    }
    Some(match method {
        "initialize" => success(id, &greeting(params)),
        "ping" => success(id, &json!({})),
        "tools/list" => success(id, &json!({ "tools": tools::list() })),
        "tools/call" => {
            let stop = Arc::new(AtomicBool::new(false));
            locked(pending).push((id.clone(), Arc::clone(&stop)));
            // Nobody receives any more once the program ends.
            let _ = calls.send(Call { id: id.clone(), params: params.clone(), stop });
            return None;
        }
        other => failure(id, METHOD_NOT_FOUND, &format!("there is no method `{other}`")),
    })
}

fn serve_calls(
    calls: &Receiver<Call>,
    tools: &Tools,
    pending: &Pending,
    told: &AtomicBool,
) -> Result<(), Fault> {
    while !told.load(Ordering::SeqCst) {
        let Ok(Call { id, params, stop }) = calls.recv_timeout(LOOK) else { continue };
        let is_stopped = || stop.load(Ordering::SeqCst);
        let answer = (!is_stopped()).then(|| answer(&id, &params, tools, &stop));
        let mut waiting = locked(pending);
        if let Some(own) = waiting.iter().position(|(_, other)| Arc::ptr_eq(other, &stop)) {
            waiting.remove(own);
        }
        drop(waiting);
        // Whoever has cancelled a call waits for no answer.
        if let Some(answer) = answer.filter(|_| !is_stopped()) {
            send(&answer)?;
        }
    }
    Ok(())
}

/// Writes a message. Without anybody to read it there is nothing more to serve.
fn send(message: &Value) -> Result<(), Fault> {
    let mut output = io::stdout().lock();
    writeln!(output, "{message}").and_then(|()| output.flush()).map_err(|error| {
        Fault::new(Exit::Io, format_args!("cannot write to the standard output: {error}"))
    })
}

/// The answer to a call.
fn answer(id: &Value, params: &Value, tools: &Tools, stop: &Arc<AtomicBool>) -> Value {
    let token = &params["_meta"]["progressToken"];
    let mut progress = |done: f64, text: String| {
        if !token.is_null() {
            let params = json!({
                "progressToken": token, "progress": done, "total": 1.0, "message": text,
            });
            let method = "notifications/progress";
            // The answer will show that nobody reads any more.
            let _ = send(&json!({ "jsonrpc": "2.0", "method": method, "params": params }));
        }
    };
    let name = params["name"].as_str().unwrap_or_default();
    let call = || tools.call(name, &params["arguments"], stop, &mut progress);
    match catch_unwind(AssertUnwindSafe(call)) {
        Ok(Answer::Text(text)) => success(id, &content(&text, false)),
        Ok(Answer::Fault(text)) => success(id, &content(&text, true)),
        Ok(Answer::BadArguments(text)) => failure(id, INVALID_PARAMS, &text),
        Err(_) => failure(id, INTERNAL_ERROR, "this is a bug in piola; please report it"),
    }
}

fn greeting(params: &Value) -> Value {
    let wanted = params["protocolVersion"].as_str().unwrap_or_default();
    let version = VERSIONS.iter().find(|known| **known == wanted).unwrap_or(&VERSIONS[0]);
    json!({
        "protocolVersion": version,
        "capabilities": { "tools": {} },
        "serverInfo": { "name": "piola", "version": env!("CARGO_PKG_VERSION") },
        "instructions": INSTRUCTIONS,
    })
}

fn content(text: &str, is_error: bool) -> Value {
    json!({ "content": [{ "type": "text", "text": text }], "isError": is_error })
}

fn success(id: &Value, result: &Value) -> Value {
    json!({ "jsonrpc": "2.0", "id": id, "result": result })
}

fn failure(id: &Value, code: i32, message: &str) -> Value {
    json!({ "jsonrpc": "2.0", "id": id, "error": { "code": code, "message": message } })
}
