-- What was answered to a request that has a key of its client's: asked again, it is answered again
-- and not done again. Written in the transaction of what the request did.
CREATE TABLE kept_reply (
  key TEXT PRIMARY KEY,
  request_digest TEXT NOT NULL,
  created_at INTEGER NOT NULL,
  reply TEXT NOT NULL
) STRICT, WITHOUT ROWID;

CREATE INDEX kept_reply_by_time ON kept_reply (created_at);
