-- What happened, in the order in which it happened. An event is written by the change itself, in the
-- change's transaction: neither is ever there without the other. The numbers have no gaps: no event
-- goes, and the number of a change that was taken back is given again.
CREATE TABLE event (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  created_at INTEGER NOT NULL
    DEFAULT (CAST((julianday('now') - 2440587.5) * 86400000000.0 AS INTEGER)),
  kind TEXT NOT NULL,
  calibration_id INTEGER REFERENCES calibration (id),
  diagnosis_id INTEGER REFERENCES diagnosis (id),
  name TEXT,
  misfit REAL,
  error TEXT,
  detail TEXT
) STRICT;

CREATE INDEX event_by_calibration ON event (calibration_id, id);

CREATE TRIGGER event_fixed BEFORE UPDATE ON event
BEGIN
  SELECT RAISE(ABORT, 'an event does not change');
END;

CREATE TRIGGER event_kept BEFORE DELETE ON event
BEGIN
  SELECT RAISE(ABORT, 'an event does not go');
END;

CREATE TRIGGER calibration_begins AFTER INSERT ON calibration
BEGIN
  INSERT INTO event (kind, calibration_id, name)
  VALUES ('calibration.' || new.state, new.id, new.name);
END;

CREATE TRIGGER calibration_changes AFTER UPDATE OF state ON calibration
WHEN new.state <> old.state
BEGIN
  INSERT INTO event (kind, calibration_id, name, misfit, error)
  VALUES ('calibration.' || new.state, new.id, new.name, new.misfit, new.error);
END;

-- Of a progress document its head, which ends before the predictions: the rest is large, and there
-- is one every second. (SQLite has no JSON functions for triggers where the schema is not trusted.)
CREATE TRIGGER calibration_progresses AFTER UPDATE OF progress ON calibration
BEGIN
  INSERT INTO event (kind, calibration_id, name, detail)
  SELECT 'calibration.progress', new.id, new.name,
         CASE WHEN head > 0 THEN substr(new.progress, 1, head - 1) || '}' END
  FROM (SELECT instr(new.progress, ',"predicted":') AS head);
END;

CREATE TRIGGER diagnosis_begins AFTER INSERT ON diagnosis
BEGIN
  INSERT INTO event (kind, calibration_id, diagnosis_id)
  VALUES ('diagnosis.' || new.state, new.calibration_id, new.id);
END;

CREATE TRIGGER diagnosis_changes AFTER UPDATE OF state ON diagnosis
WHEN new.state <> old.state
BEGIN
  INSERT INTO event (kind, calibration_id, diagnosis_id, error)
  VALUES ('diagnosis.' || new.state, new.calibration_id, new.id, new.error);
END;

-- How many evaluations there are and what they took, kept up to date so that nobody has to count.
CREATE TABLE evaluation_total (
  one INTEGER PRIMARY KEY CHECK (one = 1),
  evaluations INTEGER NOT NULL,
  seconds REAL NOT NULL
) STRICT;

INSERT INTO evaluation_total SELECT 1, count(*), coalesce(sum(seconds), 0.0) FROM evaluation;

CREATE TRIGGER evaluation_counted AFTER INSERT ON evaluation
BEGIN
  UPDATE evaluation_total SET evaluations = evaluations + 1, seconds = seconds + new.seconds;
END;
