// ---- serving: a page that polarcheck serves is loaded anew as soon as there is a next version of it ----

/**
 * Listens for the next version of the page. Does nothing on a page that is a file.
 *
 * keep: returns what to keep of the page, as JSON; restore: takes it on the new one.
 */
function served(keep, restore) {
  const meta = document.querySelector('meta[name="polarcheck-version"]');
  if (meta === null || !window.EventSource) {
    return;
  }
  const notice = document.createElement("p");
  notice.setAttribute("role", "status");
  notice.className = "serving";
  notice.style.cssText = "position:sticky;top:0;z-index:9;margin:0;padding:6px 20px;background:#5c3c00;color:#fff;white-space:pre-wrap";
  notice.hidden = true;
  document.body.prepend(notice);
  let events = null;

  function say(text) {
    notice.textContent = text;
    notice.hidden = !text;
  }

  function listen() {
    events = new EventSource(`events/${location.pathname.split("/").pop()}`);
    events.addEventListener("message", (event) => {
      const now = JSON.parse(event.data);
      if (now.version && now.version !== meta.content) {
        // A browser may refuse to store anything; the page is then shown from its beginning.
        try {
          sessionStorage.setItem(location.pathname, JSON.stringify(keep()));
        } catch (error) {
          say("");
        }
        location.reload();
        return;
      }
      say(now.notice);
    });
    events.addEventListener("error", () => say("polarcheck does not serve this page any more, or is being started anew: the picture may be old."));
  }

  // A browser holds few connections to one server: only the pages that are seen have one.
  function follow() {
    const isSeen = document.visibilityState === "visible";
    if (isSeen && events === null) {
      listen();
    } else if (!isSeen && events !== null) {
      events.close();
      events = null;
    }
  }

  let kept = null;
  try {
    kept = JSON.parse(sessionStorage.getItem(location.pathname));
    sessionStorage.removeItem(location.pathname);
  } catch (error) {
    kept = null;
  }
  if (kept !== null) {
    restore(kept);
  }
  document.addEventListener("visibilitychange", follow);
  follow();
}
