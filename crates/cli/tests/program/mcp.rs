use std::io::{BufRead, BufReader, Lines, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::Instant;

use serde_json::{Value, json};

use crate::support::{BAR, Place, assert_contains};

/// The server, spoken to line by line.
struct Server {
    child: Child,
    input: Option<ChildStdin>,
    output: Lines<BufReader<ChildStdout>>,
}

impl Server {
    fn start(place: &Place) -> Self {
        let mut program = Command::new(env!("CARGO_BIN_EXE_piola"));
        program.current_dir(place.path(".")).arg("mcp");
        program.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut child = program.spawn().unwrap();
        let input = child.stdin.take();
        let output = BufReader::new(child.stdout.take().unwrap()).lines();
        Self { child, input, output }
    }

    fn send(&mut self, line: &[u8]) {
        let input = self.input.as_mut().unwrap();
        input.write_all(line).unwrap();
        input.write_all(b"\n").unwrap();
    }

    fn say(&mut self, message: &Value) {
        self.send(message.to_string().as_bytes());
    }

    fn hear(&mut self) -> Value {
        serde_json::from_str(&self.output.next().unwrap().unwrap()).unwrap()
    }

    /// Ends the input, after which the server ends, and returns what it still says.
    fn end(mut self) -> Vec<Value> {
        drop(self.input.take());
        let rest = self.output.by_ref().map(|line| serde_json::from_str(&line.unwrap()).unwrap());
        let rest = rest.collect();
        assert!(self.child.wait().unwrap().success());
        rest
    }
}

/// What the server answers to these messages, of which this many have answers.
fn exchange(place: &Place, messages: &[Value], answers: usize) -> Vec<Value> {
    let mut server = Server::start(place);
    messages.iter().for_each(|message| server.say(message));
    let heard = (0..answers).map(|_| server.hear()).collect();
    assert_eq!(server.end(), Vec::<Value>::new());
    heard
}

fn call(id: u32, tool: &str, arguments: Value) -> Value {
    let params = json!({ "name": tool, "arguments": arguments });
    json!({ "jsonrpc": "2.0", "id": id, "method": "tools/call", "params": params })
}

/// The text of the answer to one call, which must be a fault or not.
#[track_caller]
fn called(place: &Place, tool: &str, arguments: Value, is_error: bool) -> String {
    let answers = exchange(place, &[call(1, tool, arguments)], 1);
    let result = &answers[0]["result"];
    assert_eq!(result["isError"], is_error, "{answers:?}");
    result["content"][0]["text"].as_str().unwrap().to_owned()
}

#[test]
fn a_session_begins_and_lists_tools_with_schemas() {
    let hello = json!({ "protocolVersion": "2024-11-05", "capabilities": {}, "clientInfo": { "name": "test" } });
    let answers = exchange(
        &Place::new(),
        &[
            json!({ "jsonrpc": "2.0", "id": 0, "method": "initialize", "params": hello }),
            json!({ "jsonrpc": "2.0", "method": "notifications/initialized" }),
            json!({ "jsonrpc": "2.0", "id": "a", "method": "tools/list" }),
            // An answer of the client, and what is no request, are passed over.
            json!({ "jsonrpc": "2.0", "id": 9, "result": {} }),
            json!({ "jsonrpc": "2.0", "id": 2, "method": "ping" }),
        ],
        3,
    );
    assert_eq!(answers[0]["result"]["protocolVersion"], "2024-11-05");
    assert_eq!(answers[0]["result"]["serverInfo"]["name"], "piola");
    assert_eq!(answers[1]["id"], "a");
    let tools = answers[1]["result"]["tools"].as_array().unwrap();
    let names: Vec<&str> = tools.iter().map(|tool| tool["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["schema", "check", "run", "report"]);
    assert!(tools.iter().all(|tool| tool["inputSchema"]["type"] == "object"));
    assert_eq!(answers[2]["result"], json!({}));
}

#[test]
fn a_case_is_checked_run_and_reported() {
    let place = Place::with_bar();
    let plan = called(&place, "check", json!({ "case": "bar/case.toml" }), false);
    assert_contains(&plan, &["A tiny bar", "6 particles", "first step"]);
    let slow =
        json!({ "text": BAR, "set": ["parameters.speed=0.5"], "name": "slow", "variant": null });
    let summary = called(&place, "run", slow, false);
    assert_contains(&summary, &["completed: t = 0.02 s", "kinetic"]);
    assert!(place.path("results/slow/report.html").is_file());
    let record = called(&place, "report", json!({ "results": "results/slow" }), false);
    assert_contains(&record, &["report.html", "\"outcome\""]);
    // A name that comes from a folder is made a plain one.
    place.write("bar 1.5/case.toml", BAR);
    called(&place, "run", json!({ "case": "bar 1.5/case.toml" }), false);
    assert!(place.path("results/bar-1-5/run.json").is_file());
    let part = called(&place, "schema", json!({ "key": "time" }), false);
    assert_contains(&part, &["cfl", "description"]);
    assert!(serde_json::from_str::<Value>(&part).unwrap()["properties"]["time"].is_object());
}

#[test]
fn faults_are_told_as_they_are_to_people() {
    let place = Place::with_bar();
    let text = BAR.replace("smoothing_length", "smoothing_lenght");
    let faults = called(&place, "check", json!({ "text": text }), true);
    assert_contains(&faults, &["smoothing_lenght", "did you mean `smoothing_length`?", "-->"]);
    let fast = json!({ "case": "bar/case.toml", "set": ["time.max_steps=3"] });
    assert_contains(&called(&place, "run", fast, true), &["the run failed: "]);
    let neither = called(&place, "check", json!({}), true);
    assert_contains(&neither, &["give either `case` or `text`"]);
    let none = called(&place, "schema", json!({ "key": "tim" }), true);
    assert_contains(&none, &["there is no key `tim`"]);
    let none = json!({ "results": "results/none" });
    assert_contains(&called(&place, "report", none, true), &["run.json"]);
}

#[test]
fn nothing_outside_of_the_folder_is_touched() {
    let (place, other) = (Place::with_bar(), Place::with_bar());
    let elsewhere = other.path("bar/case.toml").display().to_string();
    for case in ["../case.toml", elsewhere.as_str()] {
        let text = called(&place, "check", json!({ "case": case }), true);
        assert_contains(&text, &["is not in the folder of the server"]);
    }
    for name in ["../../up", "", ".", "..", "a/b", elsewhere.as_str()] {
        let up = json!({ "text": BAR, "name": name });
        assert_contains(&called(&place, "run", up, true), &["cannot be a name"]);
    }
    for results in ["bar", "../x", ".", "results/../bar"] {
        let text = called(&place, "report", json!({ "results": results }), true);
        assert_contains(&text, &["results"]);
        assert!(!place.path("bar/report.html").exists());
    }
    // A link in a folder of results, as a repository that was cloned could have.
    #[cfg(unix)]
    {
        called(&place, "run", json!({ "text": BAR, "name": "linked" }), false);
        std::fs::remove_dir_all(place.path("results/linked/particles")).unwrap();
        let target = other.path("bar");
        std::os::unix::fs::symlink(&target, place.path("results/linked/particles")).unwrap();
        let text = called(&place, "run", json!({ "text": BAR, "name": "linked" }), true);
        assert_contains(&text, &["is a link: remove it first"]);
        std::fs::remove_dir_all(place.path("results")).unwrap();
    }
    #[cfg(unix)]
    for target in [other.path("."), other.path("nowhere")] {
        let _ = std::fs::remove_file(place.path("results"));
        std::os::unix::fs::symlink(&target, place.path("results")).unwrap();
        let text = called(&place, "run", json!({ "text": BAR }), true);
        assert_contains(&text, &["is not in the folder of the server"]);
    }
    assert!(!other.path("case").exists() && !other.path("nowhere").exists());
}

#[test]
fn bad_messages_have_errors_and_the_server_goes_on() {
    let place = Place::new();
    let call = |id: u32, params: &str| {
        format!(
            "{{\"jsonrpc\": \"2.0\", \"id\": {id}, \"method\": \"tools/call\", \"params\": {params}}}"
        )
    };
    let lines: [(Vec<u8>, Value, i64, &str); 9] = [
        (b"no json".to_vec(), Value::Null, -32_700, "not JSON"),
        (b"{\"method\": \"ping\xff\"}".to_vec(), Value::Null, -32_700, "not JSON"),
        (b"{\"id\": 1}".to_vec(), json!(1), -32_600, "`method`"),
        (b"[]".to_vec(), Value::Null, -32_600, "`method`"),
        (b"{\"id\": 2, \"method\": \"tools/lost\"}".to_vec(), json!(2), -32_601, "tools/lost"),
        (call(3, "{\"name\": \"walk\"}").into(), json!(3), -32_602, "`walk`"),
        (
            call(4, "{\"name\": \"check\", \"arguments\": {\"set\": \"time.end=1\"}}").into(),
            json!(4),
            -32_602,
            "`set` must be a list",
        ),
        (call(5, "{\"name\": \"report\"}").into(), json!(5), -32_602, "`results` is missing"),
        (
            call(6, "{\"name\": \"check\", \"arguments\": {\"file\": \"a\"}}").into(),
            json!(6),
            -32_602,
            "`file`",
        ),
    ];
    let mut server = Server::start(&place);
    for (line, id, code, part) in lines {
        server.send(b"");
        server.send(&line);
        let answer = server.hear();
        assert_eq!(
            (&answer["id"], answer["error"]["code"].as_i64()),
            (&id, Some(code)),
            "{answer}"
        );
        assert_contains(answer["error"]["message"].as_str().unwrap(), &[part]);
    }
    assert!(server.end().is_empty());
    place.run("mcp nowhere", 4);
}

/// A run that takes for ever.
fn endless(id: u32, name: &str) -> Value {
    let set = ["time.end=1e9", "output.every=1e9", "output.table_every=1e9"];
    let mut request = call(id, "run", json!({ "case": "bar/case.toml", "set": set, "name": name }));
    request["params"]["_meta"] = json!({ "progressToken": name });
    request
}

fn cancel(id: u32) -> Value {
    let params = json!({ "requestId": id });
    json!({ "jsonrpc": "2.0", "method": "notifications/cancelled", "params": params })
}

#[test]
fn a_run_tells_how_far_it_is_and_can_be_cancelled() {
    let place = Place::with_bar();
    let mut server = Server::start(&place);
    server.say(&endless(7, "first"));
    let first = server.hear();
    assert_eq!(first["method"], "notifications/progress");
    assert_eq!(first["params"]["progressToken"], "first");
    // What needs no work is answered at once.
    server.say(&json!({ "jsonrpc": "2.0", "id": "p", "method": "ping" }));
    while server.hear()["id"] != "p" {}
    // One that waits is cancelled before it begins, and one at once with its request.
    server.say(&endless(8, "second"));
    server.say(&cancel(8));
    server.say(&cancel(7));
    server.say(&endless(9, "third"));
    server.say(&cancel(9));
    server.say(&call(10, "schema", json!({ "key": "time" })));
    // Cancelled calls have no answer.
    let answer = loop {
        let heard = server.hear();
        if heard["method"] != "notifications/progress" {
            break heard;
        }
        assert_eq!(heard["params"]["progressToken"], "first");
    };
    assert_eq!(answer["id"], 10);
    let record = place.read("results/first/run.json");
    assert_contains(&record, &["interrupted"]);
}

#[test]
fn checks_can_be_cancelled() {
    let place = Place::with_bar();
    let mut server = Server::start(&place);
    let fine = json!({ "case": "bar/case.toml", "set": ["body.bar.spacing=1e-5"] });
    let start = Instant::now();
    server.say(&call(1, "check", fine.clone()));
    // While the first one is read and built, others wait and are cancelled.
    let others = 2..=20;
    others.clone().for_each(|id| server.say(&call(id, "check", fine.clone())));
    others.for_each(|id| server.say(&cancel(id)));
    server.say(&call(21, "schema", json!({ "key": "time" })));
    assert_eq!(server.hear()["id"], 1);
    let one = start.elapsed();
    assert_eq!(server.hear()["id"], 21);
    // Nineteen checks would take as many times as long as one.
    assert!(start.elapsed() - one < 5 * one, "{one:?} and {:?}", start.elapsed());
}

#[test]
fn the_end_of_the_input_stops_a_run() {
    let place = Place::with_bar();
    let mut server = Server::start(&place);
    server.say(&endless(1, "long"));
    assert_eq!(server.hear()["method"], "notifications/progress");
    let rest = server.end();
    assert!(rest.iter().all(|message| message["method"] == "notifications/progress"), "{rest:?}");
    assert_contains(&place.read("results/long/run.json"), &["interrupted"]);
}
